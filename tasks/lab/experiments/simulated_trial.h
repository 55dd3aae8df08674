// simulated_trial: one trial with a simulated participant on simulated devices, as a cycle of
// the servo. Its time begins with the trial.
#pragma once
#include <memory>

#include "pincer/tasks/lab/experiments/hands_cycle.h"
#include "pincer/tasks/lab/experiments/simulated_hands.h"

namespace pincer::tasks {

class SimulatedTrial final : public ServoCycle {
 public:
  // `participant` must outlive the cycle.
  SimulatedTrial(std::unique_ptr<HandTrial> trial, Participant& participant);

  bool tick(double now) override { return cycle_.tick(now); }
  void cutForces() noexcept override { cycle_.cutForces(); }
  // Hands events, readings and the trial's row to the sink. Once, after the servo has returned.
  void finish() { trial_->finish(); }

  HandTrial& trial() { return *trial_; }
  HandsCycle& cycle() { return cycle_; }
  SimulatedHands& hands() { return hands_; }

 private:
  std::unique_ptr<HandTrial> trial_;
  SimulatedHands hands_;
  HandsCycle cycle_{*trial_, hands_};
};

}  // namespace pincer::tasks
