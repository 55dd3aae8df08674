// handles: one body, joint or finger of a state, by name or index.
#pragma once
#include "pincer/tasks/python/bindings/objects.h"

namespace pincer::python {

struct BodyHandle {
  State* state;
  int index;
};

struct JointHandle {
  State* state;
  int index;
};

struct FingerHandle {
  State* state;
  int index;
};

// Throw InputError, with a did-you-mean, where there is none.
BodyHandle bodyOf(State& state, const std::string& name);
BodyHandle bodyAt(State& state, int index);
JointHandle jointOf(State& state, const std::string& name);
JointHandle jointAt(State& state, int index);
FingerHandle fingerOf(State& state, const std::string& name);
FingerHandle fingerAt(State& state, int index);

}  // namespace pincer::python
