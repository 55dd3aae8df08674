#include "pincer/tasks/lab/sessions/trial_capture.h"

namespace pincer::tasks {
namespace {

void captureMount(const HandsCycle& cycle, std::size_t i, const FingerInputs& sample, FingerSnapshot& finger) {
  const MountState& mount = cycle.trial().state().mounts[i];
  const FingerOutputs& output = cycle.trial().outputs()[i];
  finger.q_WF = cycle.trial().scratch().inputs[i].q_WF;
  finger.has_device = finger.has_display = true;
  finger.device = sample.arm.valid ? devices::DeviceState::kReady : devices::DeviceState::kFaulted;
  finger.trip = mount.gate.trip;
  finger.armed = mount.gate.armed;
  finger.tactor_L = sample.tactile.valid ? sample.tactile.place_L : std::nullopt;
  finger.tactor_wanted_L = output.tactile.place_L;
  finger.tactor_parked = output.tactile.parked;
}

// The news for the person, by the last tone.
void tell(const HandTrial& trial, Cue cue, TrialSnapshot& told) {
  switch (cue) {
    case Cue::kStart:
      told.stage = "go";
      told.instruction = trial.instruction();
      break;
    case Cue::kSuccess:
      told.stage = "success";
      told.instruction = "Done: let go";
      break;
    case Cue::kEnd:
      told.stage = "time-out";
      told.instruction = "Time-out: the time of this trial is over. Let go";
      break;
    default:
      told.stage = "get ready";
      told.instruction = "Wait for the start";
  }
}

}  // namespace

TrialCapture::TrialCapture(HandsCycle& cycle, std::size_t trial, std::size_t trials, bool blind, bool guided)
    : cycle_(cycle), guided_(guided && !blind) {
  told_.condition = cycle.trial().condition().c_str();
  told_.trial = static_cast<std::int64_t>(trial) + 1;
  told_.trials = static_cast<std::int64_t>(trials);
  told_.blind = blind;
  told_.shows_pads = !blind;
  tell(cycle.trial(), Cue::kNone, told_);
}

void TrialCapture::hear() {
  if (const Cue cue = cycle_.trial().cue(); cue != Cue::kNone) tell(cycle_.trial(), cue, told_);
}

void TrialCapture::fill(Snapshot& snapshot) {
  const HandTrial& trial = cycle_.trial();
  captureGrasp(trial.scene().model.grasp, trial.state().grasp, *trial.scratch().grasp, {}, snapshot);
  const auto& samples = cycle_.hands().sample();
  for (std::size_t i = 0; i < snapshot.fingers.size(); ++i) captureMount(cycle_, i, samples[i], snapshot.fingers[i]);
  snapshot.trial = told_;
  const HandGuide guide = trial.guide();
  snapshot.trial.time_left = guide.time_left;
  if (!guided_) return;
  snapshot.trial.hint = guide.hint;
  snapshot.trial.goal_height = guide.goal_height;
  snapshot.trial.goal_heading = guide.goal_heading;
}

}  // namespace pincer::tasks
