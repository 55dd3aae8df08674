#include "tasks/experiments/live_hands.h"

#include <algorithm>

#include "devices/usb/usb_bus.h"

namespace pincer::tasks {

LiveHands::LiveHands(const HandScene& scene, HandDevices& devices)
    : devices_(devices), q_DF_(scene.q_DF.begin(), scene.q_DF.end()), samples_(kHandFingers) {
  for (int i = 0; i < kHandFingers; ++i) {
    const Pose& X_WD = scene.model.mounts[static_cast<std::size_t>(i)].X_WD;
    devices_.setBase(i, X_WD.p, X_WD.q);
    devices_.arm(i).arm();
  }
}

LiveHands::~LiveHands() { stop(); }

// The servo's zero on the system's clock: the least over the ticks, because a tick may come late but never early.
const std::vector<FingerInputs>& LiveHands::sample(double now) {
  const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
  if (!begun_ || epoch < epoch_ns_) devices_.setEpoch(epoch_ns_ = epoch);
  begun_ = true;
  devices_.advanceTo(now);
  for (int i = 0; i < kHandFingers; ++i) {
    FingerInputs& input = samples_[static_cast<std::size_t>(i)];
    input.arm = devices_.arm(i).sample();
    if (input.arm.valid && !input.arm.q_DF) input.arm.q_DF = q_DF_[static_cast<std::size_t>(i)];
    devices::TactileDisplay* display = devices_.display(i);
    input.tactile = display != nullptr ? display->sample() : devices::TactileSample{};
  }
  return samples_;
}

void LiveHands::apply(const std::vector<FingerOutputs>& outputs, Cue cue) {
  if (cue != Cue::kNone) devices_.sound(static_cast<DeviceTone>(static_cast<int>(cue) - 1));
  for (int i = 0; i < kHandFingers; ++i) {
    const FingerOutputs& output = outputs[static_cast<std::size_t>(i)];
    devices_.arm(i).commandForce(output.f_D);
    if (devices::TactileDisplay* display = devices_.display(i)) display->command(output.tactile);
  }
}

HandIntent LiveHands::intent(const TickScratch& scratch, int object) const {
  const auto& fingers = scratch.grasp.fingers;
  HandIntent intent;
  intent.wants_lift =
      std::all_of(fingers.begin(), fingers.end(), [&](const grasp::FingerReport& f) { return f.touching && f.body == object; });
  intent.phase = intent.wants_lift ? HandPhase::kSqueeze : HandPhase::kReach;
  return intent;
}

void LiveHands::stop() noexcept {
  for (int i = 0; i < kHandFingers; ++i) devices_.arm(i).stop();
}

}  // namespace pincer::tasks
