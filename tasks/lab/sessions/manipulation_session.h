// manipulation_session: a manipulation study into a session file.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

struct ManipulationSessionOptions {
  ManipulationStudy study;
  ServoOptions servo;
  std::string devices = "simulated";  // who brings arms and displays, as the session says it
  TrialHost host = {};                // who watches, and whose hands they are
  std::string claims;                 // fingerprint of the list that is to be judged by the session; empty: none
  // of the ticks that are kept [Hz], 0 (none) .. 1000; divides the servo's
  // rate. A trial's row always counts every tick.
  int sample_rate = 200;
};

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const ManipulationSessionOptions& options);

// The session's entry on its study, people, program and devices.
SessionInfo manipulationSessionInfo(const ManipulationSessionOptions& options);

// Throws InputError for a trial that the session's plan of `planned` trials doesn't have.
void requirePlanned(const SessionReader& session, std::int64_t trial, std::size_t planned);

struct ManipulationSessionResult {
  std::size_t trials = 0;                       // finished, those of a resumed session's earlier runs included
  bool interrupted = false;                     // the session says so; its finished trials are safe
  ServoReport servo;                            // of all trials of this run
  std::optional<std::uint64_t> samples_hash{};  // SessionWriter::samplesHash()
};

using TrialProgressLine = std::function<void(const TrialProgress&)>;

// Runs the study and writes it to the new file `path`. Throws InputError for bad options, a bad
// object, or a file that can't be written.
ManipulationSessionResult runManipulationSession(const ManipulationSessionOptions& options, const std::string& path,
                                                 const std::atomic<bool>& interrupted,
                                                 const TrialProgressLine& progress);

// Goes on with a session that was interrupted or killed: the study is the one in the file, finished trials
// stay, what is left of an unfinished one is removed. Throws InputError; also when the session is
// complete. `options.study` doesn't count.
ManipulationSessionResult resumeManipulationSession(const ManipulationSessionOptions& options, const std::string& path,
                                                    const std::atomic<bool>& interrupted,
                                                    const TrialProgressLine& progress);

}  // namespace pincer::tasks
