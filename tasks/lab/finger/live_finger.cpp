#include "pincer/tasks/lab/finger/live_finger.h"

#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tasks/lab/finger/finger_trial.h"

namespace pincer::tasks {

LiveFinger::LiveFinger(const FingerPlace& place, HandDevices& devices, AnswerBox& keys, double oldest_sample)
    : devices_(devices), keys_(keys) {
  wear_.arm = devices.arm(0).capabilities();
  wear_.base = devices.base(0);
  wear_.oldest_sample = oldest_sample;
  wear_.has_motors = wear_.is_person = true;
  const Pose X_WD = movedBase(place.X_WD, wear_.base);
  if (place.q_WF) q_DF_ = X_WD.q.conjugate() * *place.q_WF;
  devices_.setBase(0, X_WD.p, X_WD.q);
  devices_.arm(0).arm();
}

LiveFinger::~LiveFinger() { stop(); }

void LiveFinger::stop() noexcept {
  devices_.arm(0).stop();
  if (devices::PressureDisplay* pressure = devices_.pressure(0)) pressure->stop();
}

// The servo's zero on the system's clock: the least over the ticks, because a tick may come late but never early.
void LiveFinger::advanceTo(double now) {
  const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
  if (!begun_ || epoch < epoch_ns_) devices_.setEpoch(epoch_ns_ = epoch);
  begun_ = true;
  devices_.advanceTo(now);
}

const FingerInputs& LiveFinger::sample() {
  inputs_.arm = devices_.arm(0).sample();
  if (inputs_.arm.valid && !inputs_.arm.q_DF) inputs_.arm.q_DF = q_DF_;
  devices::TactileDisplay* display = devices_.display(0);
  inputs_.tactile = display != nullptr ? display->sample() : devices::TactileSample{};
  return inputs_;
}

FingerDeed LiveFinger::apply(const FingerOutputs& outputs, Cue cue, double) {
  if (cue != Cue::kNone) devices_.sound(static_cast<DeviceTone>(static_cast<int>(cue) - 1));
  devices_.arm(0).commandForce(outputs.f_D);
  if (devices::PressureDisplay* pressure = devices_.pressure(0)) pressure->press(outputs.f_D.norm());
  devices::TactileCommand command = outputs.tactile;
  if (!command.parked)
    command.place_L.x() = devices::transmitted(transmission_, command.place_L.x(), transmission_state_);
  if (devices::TactileDisplay* display = devices_.display(0)) display->command(command);
  tactor_place_ = inputs_.tactile.place_L.value_or(outputs.tactile.place_L).x();
  return {{}, keys_.take()};
}

}  // namespace pincer::tasks
