#include "tasks/experiments/pickup_run.h"

#include "tasks/participants/scripted_pickup.h"

namespace pincer::tasks {

SimulatedPickup::SimulatedPickup(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec,
                                 Participant& participant, RecordSink& sink)
    : trial_(options, object, spec, sink), hands_(trial_.scene(), participant) {}

std::size_t runPickupStudy(const SpherePickupOptions& options, const ServoOptions& servo, RecordSink& sink,
                           const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress,
                           const std::function<void(const ServoReport&)>& served, const TrialHost& host) {
  const auto trials = pickupTrials(options);
  const PickupObject object = makePickupObject(options);
  const auto report = [&](std::size_t done) {
    if (progress) progress({done, trials.size()});
  };
  std::size_t done = 0;
  report(done);
  for (const PickupTrialSpec& spec : trials) {
    ScriptedPickup participant(participantSeed(options, spec.participant));
    PickupTrial trial(options, object, spec, sink);
    const std::unique_ptr<Hands> hands =
        host.hands ? host.hands(trial.scene()) : std::make_unique<SimulatedHands>(trial.scene(), participant);
    HandsCycle cycle(trial, *hands);
    const ServoReport servo_report = host.serve ? host.serve(cycle, done, trials.size()) : runServo(servo, cycle, interrupted);
    if (served) served(servo_report);
    if (servo_report.interrupted) break;
    trial.finish();
    report(++done);
  }
  return done;
}

}  // namespace pincer::tasks
