// pickup_run: sphere pickup with a simulated participant on simulated devices, a trial or a whole study, under the servo that the caller
// chooses (virtual or real time).
#pragma once
#include <atomic>
#include <functional>

#include "tasks/experiments/hands_cycle.h"
#include "tasks/experiments/pickup_trial.h"
#include "tasks/experiments/simulated_hands.h"
#include "tasks/servo/servo.h"

namespace pincer::tasks {

// One trial as a cycle of the servo. The servo's time begins with the trial.
class SimulatedPickup final : public ServoCycle {
 public:
  // `participant` must outlive the cycle.
  SimulatedPickup(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec, Participant& participant,
                  RecordSink& sink);

  bool tick(double now) override { return cycle_.tick(now); }
  void cutForces() noexcept override { cycle_.cutForces(); }
  // Hands events and the trial's row to the sink. Once, after the servo has returned.
  void finish() { trial_.finish(); }

  PickupTrial& trial() { return trial_; }
  SimulatedHands& hands() { return hands_; }

 private:
  PickupTrial trial_;
  SimulatedHands hands_;
  HandsCycle cycle_{trial_, hands_};
};

struct PickupProgress {
  std::size_t done = 0, total = 0;  // trials
};

// Every trial of the study, with the scripted participant unless `host` brings other hands. An interrupted trial leaves no row. Returns the number of finished trials.
// `progress` (may be empty) is called before the first and after every trial, `served` (may be empty) with what the servo says of each, the
// interrupted one included. Throws InputError for bad options or a bad object.
std::size_t runPickupStudy(const SpherePickupOptions& options, const ServoOptions& servo, RecordSink& sink,
                           const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress = {},
                           const std::function<void(const ServoReport&)>& served = {}, const TrialHost& host = {});

}  // namespace pincer::tasks
