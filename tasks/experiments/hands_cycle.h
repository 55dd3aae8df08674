// hands_cycle: a trial and the hands that do it, as a cycle of the servo; and who runs such cycles.
#pragma once
#include <atomic>
#include <functional>
#include <memory>

#include "tasks/experiments/hand_trial.h"
#include "tasks/experiments/hands.h"
#include "tasks/servo/servo.h"

namespace pincer::tasks {

// Both must outlive it. The servo's time begins with the trial.
class HandsCycle final : public ServoCycle {
 public:
  HandsCycle(HandTrial& trial, Hands& hands) : trial_(trial), hands_(hands) {}

  bool tick(double now) override {
    hands_.advanceTo(now);
    if (cut_) trial_.cutForces(devices::Trip::kMissedDeadline);
    const bool more = trial_.step(hands_.sample(), hands_.intent(), now);
    hands_.apply(trial_.outputs(), trial_.cue(), now);
    return more;
  }
  void cutForces() noexcept override { cut_ = true; }

  const HandTrial& trial() const { return trial_; }
  Hands& hands() const { return hands_; }

 private:
  HandTrial& trial_;
  Hands& hands_;
  std::atomic<bool> cut_{false};
};

// Somebody who watches, or whose hands do the trials. Empty functions: nobody does, and simulated participants do them.
struct TrialHost {
  std::function<std::unique_ptr<Hands>(const HandScene& scene)> hands;
  std::function<ServoReport(HandsCycle& cycle, std::size_t trial, std::size_t trials)> serve;
};

}  // namespace pincer::tasks
