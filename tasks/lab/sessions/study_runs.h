// study_runs: many experiments of each published study with one finger, each a session in a file of its own, for who judges them together
// (tasks/lab/findings/published_figures.h).
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace pincer::tasks {

struct StudyRuns {
  int experiments = 20;   // of each study; each has other participants
  int participants = 12;  // in each
  std::uint64_t seed = 1;
  int threads = 2;
  std::string only;       // studies whose name holds one of these, separated by commas; empty: all
  std::string directory;  // of the sessions: TASK-K.db
};

struct StudySessions {
  std::string task;
  std::vector<std::string> paths;
};

// Sessions that are there and complete stay as they are, unfinished ones are gone on with. `progress` in thousandths, from any thread, one at a
// time. Throws InputError for a session of another design or other participants.
std::vector<StudySessions> runPublishedStudies(const StudyRuns& runs, const std::atomic<bool>& interrupted,
                                               const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace pincer::tasks
