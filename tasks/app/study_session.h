// study_session: a psychophysical experiment into a session file.
#pragma once
#include <atomic>
#include <functional>
#include <string>

#include "tasks/experiments/study.h"
#include "tasks/session/session_store.h"

namespace pincer::tasks {

struct StudySession {
  SessionInfo info;
  std::string path;  // of the new file
  bool real_time = false;
};

// Runs the study and writes it to the new file. Throws InputError for a file that can't be written.
StudyOutcome runStudySession(Experiment& experiment, const StudySession& session, const std::atomic<bool>& interrupted,
                             const std::function<void(const StudyProgress&)>& progress);

}  // namespace pincer::tasks
