#include "pincer/devices/usb/usb_arm.h"

#include "pincer/devices/arm/premium_kinematics.h"

namespace pincer::devices::usb {

ArmSample UsbArm::sample() {
  const auto& [state, sent_ns] = latestReading();
  ArmSample sample;
  sample.time = sinceEpoch(sent_ns);
  const bool ready = linkState() == DeviceState::kReady;
  sample.gave_up = ready && state.limp && arming_ != 0 && state.arming == arming_;
  sample.valid = ready && state.valid && !sample.gave_up;
  if (!sample.valid) return sample;
  sample.p_DF = state.p_DF;
  sample.v_DF = state.v_DF;
  sample.q_DF = state.q_DF;
  if (state.switches) sample.switches = *state.switches;
  if (deviceIdentity().linkage == Linkage::kPremium) {
    if (const auto q = premium::inverse(state.p_DF)) sample.J = premium::jacobian(*q);
  }
  return sample;
}

void UsbArm::commandForce(const Vec3& f_D) {
  const bool may = armed_.load(std::memory_order_acquire) && f_D.allFinite();
  post({may ? f_D : Vec3::Zero(), deadline_, may ? arming_ : std::uint16_t{0}, signal_});
  signal_ = Signal::kNone;
}

void UsbArm::arm() {
  arming_ = static_cast<std::uint16_t>(arming_ == 0xffff ? 1 : arming_ + 1);  // 0 arms nothing
  stop_.store(false, std::memory_order_relaxed);
  armed_.store(linkState() == DeviceState::kReady, std::memory_order_release);
}

void UsbArm::stop() noexcept {
  armed_.store(false, std::memory_order_release);
  stop_.store(true, std::memory_order_release);
  wakeUsb();
}

void UsbArm::attach(std::int64_t now, std::uint32_t sequence) {
  armed_.store(false, std::memory_order_release);
  DeviceLink::attach(now, sequence);
}

void UsbArm::detach() {
  armed_.store(false, std::memory_order_release);
  DeviceLink::detach();
}

// Whatever was asked before a stop or an unplugging is not force any more.
void UsbArm::checkCommand(ArmCommand& command) {
  if (armed_.load(std::memory_order_acquire)) return;
  command.f_D = Vec3::Zero();
  command.arming = 0;
}

}  // namespace pincer::devices::usb
