// inputs: what a step is told from Python. Its tables never move, so that views of them stay valid.
#pragma once
#include "pincer/tasks/python/bindings/objects.h"

namespace pincer::python {

struct Inputs : tasks::SceneInputs {
  explicit Inputs(ModelPointer of) : SceneInputs(*of), model(std::move(of)) {}

  // Values only: the tables have the same sizes and stay where they are.
  void clear() {
    const tasks::SceneInputs nothing(*model);
    static_cast<tasks::SceneInputs&>(*this) = nothing;
  }

  ModelPointer model;
};

}  // namespace pincer::python
