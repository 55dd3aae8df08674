// study_sweep: a study of the manipulation tasks with simulated participants, for many
// values of its parameters, and what they did.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/lab/sweep/sweep.h"

namespace pincer::tasks {

// Studies of one sweep, each of many trials: bounds a mistaken grid; chosen.
constexpr std::size_t kMostStudyCases = 1000;

struct StudySweep {
  SweepGrid grid;        // paths in the study file (pincer run manipulation --write-study FILE)
  int participants = 4;  // at each point, 1 .. 1000; the same people at every one
  std::uint64_t seed = 1;
};

// sphere-pickup, cylinder-alignment, manipulation.
bool isSweptStudy(const std::string& task);

// Every measure (tasks/lab/report/person_means.h) twice, force only and CLD + force: means over the participants;
// squeezes, times and the error of alignment are plotted. Without training: these participants don't learn. Throws
// InputError where no case can be read: for a path that isn't in a study.
SweepJob studySweep(const std::string& task, const StudySweep& sweep);

}  // namespace pincer::tasks
