#include "tasks/experiments/simulated_trial.h"

namespace pincer::tasks {

SimulatedTrial::SimulatedTrial(std::unique_ptr<HandTrial> trial, Participant& participant)
    : trial_(std::move(trial)), hands_(trial_->scene(), participant) {}

}  // namespace pincer::tasks
