#include "tasks/experiments/live_pickup.h"

#include <algorithm>
#include <utility>

#include "devices/usb/usb_bus.h"

namespace pincer::tasks {

LivePickup::LivePickup(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec, HandDevices& devices,
                       RecordSink& sink)
    : trial_(options, object, spec, sink), hands_(trial_.scene(), devices) {
  trial_.keepPassive();
}

bool LivePickup::tick(double now) {
  if (cut_) trial_.cutForces(devices::Trip::kMissedDeadline);
  const std::int64_t start = devices::usb::monotonicNs();
  const std::vector<FingerInputs>& samples = hands_.sample(now);
  const std::int64_t sampled = devices::usb::monotonicNs();
  const bool more = trial_.step(samples, hands_.intent(std::as_const(trial_).scratch(), trial_.scene().object), now);
  const std::int64_t stepped = devices::usb::monotonicNs();
  hands_.apply(trial_.outputs(), trial_.cue());
  samples_.add(1e-9 * static_cast<double>(sampled - start));
  step_.add(1e-9 * static_cast<double>(stepped - sampled));
  commands_.add(1e-9 * static_cast<double>(devices::usb::monotonicNs() - stepped));
  return more;
}

void LivePickup::cutForces() noexcept {
  cut_ = true;
  hands_.stop();
}

bool LivePickup::finish() {
  hands_.stop();
  trial_.finish();
  const auto& mounts = trial_.state().mounts;
  return std::all_of(mounts.begin(), mounts.end(), [](const MountState& m) { return m.gate.trip == devices::Trip::kNone; });
}

std::size_t runLivePickupStudy(const SpherePickupOptions& options, const ServoOptions& servo, RecordSink& sink, const LiveSession& live,
                               const std::atomic<bool>& interrupted, const std::function<void(const PickupProgress&)>& progress,
                               const std::function<void(const ServoReport&)>& served) {
  const auto trials = pickupTrials(options);
  const PickupObject object = makePickupObject(options);
  std::size_t done = 0;
  if (!live.arm("the session begins")) return done;
  for (const PickupTrialSpec& spec : trials) {
    progress({done, trials.size()});
    LivePickup cycle(options, object, spec, *live.devices, sink);
    const ServoReport report = runServo(servo, cycle, interrupted);
    served(report);
    if (report.interrupted) break;
    const bool clean = cycle.finish();
    ++done;
    if (!clean && done < trials.size() && !live.arm("a fault cut the forces in the last trial")) break;
  }
  progress({done, trials.size()});
  return done;
}

}  // namespace pincer::tasks
