#include "pincer/tasks/lab/experiments/simulated_trial.h"

namespace pincer::tasks {

SimulatedTrial::SimulatedTrial(std::unique_ptr<HandTrial> trial, Participant& participant)
    : trial_(std::move(trial)), hands_(trial_->scene(), participant) {
  for (int i = 0; i < kHandFingers; ++i) trial_->fitTo(i, hands_.arm(i).capabilities());
}

}  // namespace pincer::tasks
