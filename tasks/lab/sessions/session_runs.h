// session_runs: many experiments, each a session in a file of its own, shared among threads.
//
// A session that is complete stays as it is, one that was interrupted or killed is gone on with; so the same command,
// given again, takes up where it was left. Nothing runs if a file that is there is of something else.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

using ShareDone = std::function<void(double share)>;  // 0 .. 1

struct SessionRun {
  std::string path;
  SessionInfo info;  // of what would be run
  // all of it, or what is left; ends early where the user interrupts
  std::function<void(bool resume, const ShareDone& share)> run;
};

// In this order, as far as threads go. `progress` in thousandths, from any thread, one at a time. Throws InputError for
// a session of another protocol, seed or other participants, and passes on what a run throws.
void runSessions(const std::vector<SessionRun>& runs, int threads, const std::atomic<bool>& interrupted,
                 const std::function<void(std::int64_t done, std::int64_t total)>& progress);

}  // namespace pincer::tasks
