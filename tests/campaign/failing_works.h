// failing_works: short runs of the program in which one call of the system, or one allocation,
// fails; and what must be true afterwards.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "pincer/tests/campaign/row.h"

namespace pincer::campaign {

struct Work {
  std::vector<std::string> arguments;
  bool is_session = false;
};

// A session first: it has the most to lose.
std::vector<Work> works(const Ground& ground);

// How often an undisturbed run of `work` makes each call that can be made to fail, by the call's name
// (failing_calls_preload.cpp), and how often it asks for memory, under kAllocation. Counted once per command line.
using Counts = std::map<std::string, long>;
inline const std::string kAllocation = "allocation";
const Counts& callsOf(const Ground& ground, const Work& work);

// One failure: the `at`-th call, and all from there on where it lasts.
struct Failure {
  std::string call;
  long at = 1;
  int error = 0;  // errno; 0: half of what was to be written is
  bool lasts = false;
};

// `work` with the failure, in the case's folder; judged: no crash, a documented
// exit code, a sentence, and nothing lost.
void runWithFailure(Case& c, const Work& work, const Failure& failure);

}  // namespace pincer::campaign
