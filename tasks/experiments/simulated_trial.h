// simulated_trial: one trial with a simulated participant on simulated devices, as a cycle of the servo. Its time begins with the trial.
#pragma once
#include <atomic>
#include <memory>

#include "tasks/experiments/hand_trial.h"
#include "tasks/experiments/simulated_hands.h"
#include "tasks/servo/servo.h"

namespace pincer::tasks {

class SimulatedTrial final : public ServoCycle {
 public:
  // `participant` must outlive the cycle.
  SimulatedTrial(std::unique_ptr<HandTrial> trial, Participant& participant);

  bool tick(double now) override;
  void cutForces() noexcept override { cut_ = true; }
  // Hands events, readings and the trial's row to the sink. Once, after the servo has returned.
  void finish() { trial_->finish(); }

  HandTrial& trial() { return *trial_; }
  SimulatedHands& hands() { return hands_; }

 private:
  std::unique_ptr<HandTrial> trial_;
  SimulatedHands hands_;
  std::atomic<bool> cut_{false};
};

}  // namespace pincer::tasks
