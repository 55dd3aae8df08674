// study_session: a psychophysical experiment into a session file.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/run/session_store.h"

namespace pincer::tasks {

struct StudySession {
  SessionInfo info;
  std::string path;      // of the file
  bool resume = false;   // go on with the session in the file; else the file is new
  FingerHost host = {};  // who does the trials, and who watches
  bool waits = true;     // for the disk; no: samples are dropped rather than ticks
};

// A session's entry on a study, its people, this program and its devices. `sample_rate` of what is kept [Hz]; 0:
// nothing is. `devices`: who brings arm and display, as --devices names it.
SessionInfo studySessionInfo(const std::string& task, std::uint64_t seed, const std::string& protocol_json,
                             const std::string& participants_json, const ServoOptions& servo, int sample_rate,
                             const std::string& devices = "simulated");

// Runs the study, or what is left of it, and writes it to the file. Throws InputError for a file that can't be written,
// and for a session whose answers aren't those of this study.
StudyOutcome runStudySession(Experiment& experiment, const StudySession& session, const std::atomic<bool>& interrupted,
                             const std::function<void(const StudyProgress&)>& progress);

}  // namespace pincer::tasks
