// live_pickup: sphere pickup by a person who wears real devices, a trial or a whole study, in real time.
//
// Forces come on only after the operator said so: before the first trial, and again before the trial after one that ended in a fault.
#pragma once
#include <functional>

#include "tasks/experiments/live_hands.h"
#include "tasks/experiments/pickup_run.h"
#include "tasks/experiments/pickup_trial.h"

namespace pincer::tasks {

class LivePickup final : public ServoCycle {
 public:
  LivePickup(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec, HandDevices& devices,
             RecordSink& sink);

  bool tick(double now) override;
  void cutForces() noexcept override;
  std::vector<StageTimes> stages() const override { return {{"samples", samples_}, {"physics, gate", step_}, {"commands", commands_}}; }
  // Hands events and the trial's row to the sink. Once, after the servo has returned. Whether the gates stayed closed on nothing.
  bool finish();

 private:
  PickupTrial trial_;
  LiveHands hands_;
  Histogram samples_, step_, commands_;  // [s]
  std::atomic<bool> cut_{false};
};

// What a session with real devices needs besides the study. `arm` asks the operator whether forces may come on; false ends the session.
struct LiveSession {
  HandDevices* devices = nullptr;
  std::function<bool(const std::string& why)> arm;
};

// As runPickupStudy(), with a person in place of the simulated participant. `servo.real_time` must be set.
std::size_t runLivePickupStudy(const SpherePickupOptions& options, const ServoOptions& servo, RecordSink& sink, const LiveSession& live,
                               const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress,
                               const std::function<void(const ServoReport&)>& served);

}  // namespace pincer::tasks
