// study_runs: many experiments of each published study with one finger, each a session in a file of its own, for who
// judges them together (tasks/lab/findings/claim_judge.h).
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "pincer/tasks/lab/findings/claim_judge.h"

namespace pincer::tasks {

struct StudyRuns {
  int experiments = 20;  // of each study; each has other participants
  int controls = 0;      // likewise, the same people, under each control that the study has (StudySessions)
  int participants = 0;  // in each; 0: as published
  std::uint64_t seed = 1;
  int threads = 2;
  int part = 1, parts = 1;  // runs only every parts-th experiment, beginning with the part-th
  std::string only;         // studies whose name holds one of these, separated by commas; empty: all
  std::string directory;    // of the sessions: TASK-K.db, TASK-frozen-K.db, TASK-unrelated-K.db
};

// Sessions that are there and complete stay as they are, unfinished ones are gone on with. `progress` in thousandths,
// from any thread, one at a time. Returns whatever is there in the end, of other parts too. Throws InputError for a
// session of another design or other participants.
StudySessions runPublishedStudies(const StudyRuns& runs, const std::atomic<bool>& interrupted,
                                  const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace pincer::tasks
