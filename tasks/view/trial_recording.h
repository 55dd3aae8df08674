// trial_recording: every tick of a trial, kept to be looked at: played, paused, scrubbed.
#pragma once
#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/finger/finger_trial.h"
#include "pincer/tasks/view/history.h"
#include "pincer/tasks/view/view_run.h"

namespace pincer::tasks {

struct TrialRecording {
  History history;
  ServoReport report;
};

// Runs the trial in virtual time. About 1 KB per tick.
TrialRecording recordTrial(HandsCycle& cycle, std::size_t trial, std::size_t trials,
                           const std::atomic<bool>& interrupted);

// Likewise of a trial with one finger, as whoever knows all sees it.
TrialRecording recordFinger(FingerTrial& trial, const std::atomic<bool>& interrupted);

// Shows it from `time` [s] on, in a window until the person closes it, or, without --view, as one picture in the file
// of --screenshot. Throws devices::DisplayError where there is no display.
void showRecording(const grasp::GraspModel& model, History recording, double time, const ViewOptions& options,
                   const std::atomic<bool>& interrupted);

}  // namespace pincer::tasks
