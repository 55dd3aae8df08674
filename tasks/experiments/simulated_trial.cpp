#include "tasks/experiments/simulated_trial.h"

namespace pincer::tasks {

SimulatedTrial::SimulatedTrial(std::unique_ptr<HandTrial> trial, Participant& participant)
    : trial_(std::move(trial)), hands_(trial_->scene(), participant) {}

bool SimulatedTrial::tick(double now) {
  hands_.advanceTo(now);
  if (cut_) trial_->cutForces(devices::Trip::kMissedDeadline);
  const bool more = trial_->step(hands_.sample(), hands_.intent(), now);
  hands_.apply(trial_->outputs(), trial_->cue(), now);
  return more;
}

}  // namespace pincer::tasks
