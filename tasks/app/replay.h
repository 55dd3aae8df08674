// replay: runs a session again and compares it, tick by tick, to the bit.
//
// A session with simulated participants holds its inputs as its protocol and seeds: devices and participants are deterministic, so that every
// sample of theirs comes again through the same tick. Each kept sample, each reading and each trial's row is compared; how long ticks took is
// not. A session with people can't be replayed: their hands' samples are kept as positions only, at the rate of the session.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "tasks/experiments/hands_cycle.h"
#include "tasks/session/session_store.h"

namespace pincer::tasks {

struct ReplayDifference {
  std::int64_t trial = 0, tick = -1;  // -1: in the trial's row
  double time = 0;                    // [s]
  std::string what;                   // column, stored and new value
};

struct ReplayResult {
  std::int64_t trials = 0, samples = 0;  // compared
  std::optional<ReplayDifference> first;
};

// Runs a trial's cycle in virtual time, and may look at it; the row is the stored one.
using ReplayRun = std::function<ServoReport(HandsCycle& cycle, const TrialRecord& row)>;

// Every finished trial, or only `trial`. Stops at the first difference. Throws InputError for a session that can't be replayed.
ReplayResult replaySession(const SessionReader& session, std::optional<std::int64_t> trial, const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t done, std::int64_t total)>& progress = {}, const ReplayRun& run = {});

}  // namespace pincer::tasks
