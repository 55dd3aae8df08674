#include "pincer/tasks/lab/experiments/live_hands.h"

#include <algorithm>

#include "pincer/devices/usb/usb_bus.h"
#include "pincer/devices/window/input.h"

namespace pincer::tasks {

LiveHands::LiveHands(HandTrial& trial, HandDevices& devices, double oldest_sample, AnswerBox* keys)
    : trial_(trial), devices_(devices), keys_(keys), samples_(kHandFingers) {
  trial.keepPassive();
  trial.standArms({devices.base(0), devices.base(1)});
  trial.trustSamples(oldest_sample);
  q_DF_.assign(trial.scene().q_DF.begin(), trial.scene().q_DF.end());
  const HandScene& scene = trial.scene();
  for (int i = 0; i < kHandFingers; ++i) {
    const Pose& X_WD = scene.model.mounts[static_cast<std::size_t>(i)].X_WD;
    devices_.setBase(i, X_WD.p, X_WD.q);
    trial.fitTo(i, devices_.arm(i).capabilities());
    devices_.arm(i).arm();
  }
}

LiveHands::~LiveHands() { stop(); }

// The servo's zero on the system's clock: the least over the ticks, because a tick may come late but never early.
void LiveHands::advanceTo(double now) {
  const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
  if (!begun_ || epoch < epoch_ns_) devices_.setEpoch(epoch_ns_ = epoch);
  begun_ = true;
  devices_.advanceTo(now);
}

const std::vector<FingerInputs>& LiveHands::sample() {
  for (int i = 0; i < kHandFingers; ++i) {
    FingerInputs& input = samples_[static_cast<std::size_t>(i)];
    input.arm = devices_.arm(i).sample();
    if (input.arm.valid && !input.arm.q_DF) input.arm.q_DF = q_DF_[static_cast<std::size_t>(i)];
    devices::TactileDisplay* display = devices_.display(i);
    input.tactile = display != nullptr ? display->sample() : devices::TactileSample{};
  }
  readIntent();
  return samples_;
}

void LiveHands::apply(const std::vector<FingerOutputs>& outputs, Cue cue, double) {
  if (cue != Cue::kNone) devices_.sound(static_cast<DeviceTone>(static_cast<int>(cue) - 1));
  for (int i = 0; i < kHandFingers; ++i) {
    const FingerOutputs& output = outputs[static_cast<std::size_t>(i)];
    devices_.arm(i).commandForce(output.f_D);
    if (devices::TactileDisplay* display = devices_.display(i)) display->command(output.tactile);
    // No force, no pressure: a gate that tripped ends both.
    const double normal_force =
        output.f_D.isZero(0) ? 0 : trial_.scratch().fingers[static_cast<std::size_t>(i)].normal_force;
    if (devices::PressureDisplay* pressure = devices_.pressure(i)) pressure->press(normal_force);
  }
}

void LiveHands::readIntent() {
  const auto& fingers = trial_.scratch().fingers;
  const int object = trial_.scene().object;
  intent_.wants_lift = std::all_of(fingers.begin(), fingers.end(),
                                   [&](const grasp::FingerReport& f) { return f.touching && f.body == object; });
  intent_.answers = keys_ && keys_->take() == devices::kKeyEnter;
  intent_.phase = intent_.wants_lift ? HandPhase::kSqueeze : HandPhase::kReach;
}

void LiveHands::stop() noexcept {
  for (int i = 0; i < kHandFingers; ++i) {
    devices_.arm(i).stop();
    if (devices::PressureDisplay* pressure = devices_.pressure(i)) pressure->stop();
  }
}

}  // namespace pincer::tasks
