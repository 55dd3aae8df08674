// replay: runs a session again and compares it, tick by tick, to the bit.
//
// A session with simulated participants holds its inputs as its protocol and seeds: devices and participants are
// deterministic, so that every sample of theirs comes again through the same tick. Of people every tick's inputs are
// kept (InputRecord): what arms and displays said and what the hand meant; they are given to the same tick again, also
// those of a trial that was cut short. Each kept sample, each tick's input and outcome, each event, reading and trial's
// row is compared; how long ticks took is not.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/finger/finger_trial.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

struct ReplayDifference {
  std::int64_t trial = 0, tick = -1;  // -1: in the trial's row, its events or readings
  double time = 0;                    // [s]
  std::string what;                   // column, stored and new value
};

struct ReplayResult {
  std::int64_t trials = 0, cut_short = 0;  // compared: finished trials, and others
  std::int64_t samples = 0, inputs = 0;    // compared
  std::vector<std::string> notes;          // sentences about what couldn't be compared, and about another version
  std::vector<std::string> surroundings;   // that aren't those of the session: compiler, flags, C library, processor
  std::optional<ReplayDifference> first;
};

// Runs a trial's cycle in virtual time, and may look at it; the row is the stored one.
using ReplayRun = std::function<ServoReport(HandsCycle& cycle, const TrialRecord& row)>;
// Likewise of a trial with one finger.
using FingerReplayRun = std::function<ServoReport(FingerTrial& trial)>;

struct ReplayOptions {
  std::optional<std::int64_t> trial{};  // only this one
  bool other_version = false;           // also of a session that a program with other sources made
};

// Every trial, or only one. Stops at the first difference. Throws InputError for a session that can't be
// replayed: of another task, without people's inputs, with doubled trials, by a program of another
// version or with other sources (build_info.h).
ReplayResult replaySession(const SessionReader& session, const ReplayOptions& options,
                           const std::atomic<bool>& interrupted,
                           const std::function<void(std::int64_t done, std::int64_t total)>& progress = {},
                           const ReplayRun& run = {}, const FingerReplayRun& finger_run = {});

}  // namespace pincer::tasks
