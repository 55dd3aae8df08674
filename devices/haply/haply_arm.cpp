#include "pincer/devices/haply/haply_arm.h"

#include "pincer/devices/usb/usb_bus.h"

namespace pincer::devices::haply {

HaplyArm::HaplyArm(HaplyArmSettings settings, std::function<void()> wake)
    : settings_(std::move(settings)), map_(settings_.frame), wake_(std::move(wake)) {
  capabilities_.peak_force = settings_.peak_force;
  capabilities_.continuous_force = settings_.continuous_force;
  capabilities_.stiffness_limit = 300;
  capabilities_.workspace_min_D = Vec3::Constant(-0.1);  // radius of an Inverse3; a Minverse has 0.04
  capabilities_.workspace_max_D = Vec3::Constant(0.1);
}

ArmSample HaplyArm::sample() {
  readings_.update();
  const ArmReading& reading = readings_.current();
  ArmSample sample;
  sample.time = 1e-9 * static_cast<double>(reading.ns - epoch_ns_);
  sample.valid = reading.valid && state() == DeviceState::kReady;
  if (!sample.valid) return sample;
  sample.p_DF = map_.place(reading.p_H);
  if (reading.v_H) sample.v_DF = map_.velocity(*reading.v_H);
  if (reading.q_H) sample.q_DF = map_.turn(*reading.q_H);
  sample.switches = reading.buttons;
  return sample;
}

void HaplyArm::commandForce(const Vec3& f_D) {
  wishes_.writable() = {f_D.allFinite() ? f_D : Vec3::Zero(), usb::monotonicNs()};
  wishes_.publish();
}

void HaplyArm::arm() {
  stopped_.store(false, std::memory_order_release);
  armings_.fetch_add(1, std::memory_order_acq_rel);
}

void HaplyArm::stop() noexcept {
  stopped_.store(true, std::memory_order_release);
  wake_();
}

void HaplyArm::bring(HaplySession& session, std::size_t index, std::int64_t now) {
  const std::uint32_t armings = armings_.load(std::memory_order_acquire);
  if (stopped()) {
    session.disarm(index);
  } else if (armings != armings_seen_) {
    session.arm(index, now);
  }
  armings_seen_ = armings;
  wishes_.update();
  const Wish& wish = wishes_.current();
  session.want(index, now - wish.ns < kWishLife ? map_.force(wish.f_D) : Vec3(Vec3::Zero()));
}

void HaplyArm::publish(const ArmReading& reading, DeviceState state) {
  readings_.writable() = reading;
  readings_.publish();
  state_.store(state, std::memory_order_release);
}

}  // namespace pincer::devices::haply
