// study_replay: a session of an experiment with one finger again, trial by trial through the same study: simulated
// participants do theirs again, a person's finger and keys are given as they were recorded.
#pragma once
#include "pincer/tasks/lab/sessions/replay.h"

namespace pincer::tasks {

struct StudyReplay {
  const SessionReader& session;
  bool simulated;
  std::optional<std::int64_t> trial;  // only this one
  const std::atomic<bool>& interrupted;
  const std::function<void(std::int64_t done, std::int64_t total)>& progress;
  const FingerReplayRun& run;  // empty: in virtual time
};

// Adds to `result`; stops at the first difference. Throws InputError for a session without a trial to compare.
void replayStudy(const StudyReplay& replay, ReplayResult& result);

// A trial's inputs from tick 0 to where one is missing; `all`: none was.
std::vector<InputRecord> wholeInputs(const SessionReader& session, std::int64_t trial, bool& all);

}  // namespace pincer::tasks
