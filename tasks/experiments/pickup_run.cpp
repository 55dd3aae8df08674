#include "tasks/experiments/pickup_run.h"

#include "tasks/participants/scripted_pickup.h"

namespace pincer::tasks {

SimulatedPickup::SimulatedPickup(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec,
                                 Participant& participant, RecordSink& sink)
    : trial_(options, object, spec, sink), hands_(trial_.scene(), participant) {}

bool SimulatedPickup::tick(double now) {
  hands_.advanceTo(now);
  if (cut_) trial_.cutForces(devices::Trip::kMissedDeadline);
  const bool more = trial_.step(hands_.sample(), hands_.intent(), now);
  hands_.apply(trial_.outputs(), trial_.cue(), now);
  return more;
}

std::size_t runPickupStudy(const SpherePickupOptions& options, const ServoOptions& servo, RecordSink& sink,
                           const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress,
                           const std::function<void(const ServoReport&)>& served) {
  const auto trials = pickupTrials(options);
  const PickupObject object = makePickupObject(options);
  const auto report = [&](std::size_t done) {
    if (progress) progress({done, trials.size()});
  };
  std::size_t done = 0;
  report(done);
  for (const PickupTrialSpec& spec : trials) {
    ScriptedPickup participant(participantSeed(options, spec.participant));
    SimulatedPickup cycle(options, object, spec, participant, sink);
    const ServoReport servo_report = runServo(servo, cycle, interrupted);
    if (served) served(servo_report);
    if (servo_report.interrupted) break;
    cycle.finish();
    report(++done);
  }
  return done;
}

}  // namespace pincer::tasks
