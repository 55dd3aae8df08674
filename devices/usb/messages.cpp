#include "pincer/devices/usb/messages.h"

#include "pincer/devices/usb/payload.h"

namespace pincer::devices::usb {
namespace {

constexpr double kNano = 1e-9, kMicro = 1e-6;                        // [m], [N] or [m/s]
constexpr double kReach = 2, kForce = 100, kSpeed = 50, kPad = 0.1;  // [m], [N], [m/s], [m]
constexpr double kGimbalStep = 1.0 / 16384;                          // of a quaternion's component: 0.007 degrees
constexpr double kTorqueStep = 1e-4, kTorque = 6.5;                  // [N m]
constexpr double kMassStep = 1e-4, kMass = 6.5;                      // [kg]
constexpr double kDampingStep = 1e-3, kDamping = 65;                 // [N s/m]

enum ArmBit : std::uint8_t {
  kArmValid = 1,
  kArmLimp = 2,
  kArmVelocity = 4,
  kArmGimbal = 8,
  kArmSwitches = 16,
  kArmBits = 31
};
enum DisplayBit : std::uint8_t { kDisplayValid = 1, kDisplayParked = 2, kDisplayPlace = 4, kDisplayBits = 7 };

Frame frameOf(FrameType type) {
  Frame frame;
  frame.type = type;
  return frame;
}

template <typename Message>
std::optional<Message> whole(PayloadReader& in, const Message& message) {
  return in.complete() ? std::optional<Message>(message) : std::nullopt;
}

Signal takeSignal(PayloadReader& in) {
  const auto value = in.take<std::uint8_t>();
  in.require(value <= static_cast<std::uint8_t>(Signal::kEnd));
  return static_cast<Signal>(value);
}

bool takeFlag(PayloadReader& in) {
  const auto value = in.take<std::uint8_t>();
  in.require(value <= 1);
  return value == 1;
}

void putGimbal(PayloadWriter& out, const Quat& q) {
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) out.putScaled<std::int16_t>(c, kGimbalStep, 1);
}

Quat takeGimbal(PayloadReader& in, bool there) {
  std::array<double, 4> c{};
  for (double& value : c) value = in.takeScaled<std::int16_t>(kGimbalStep, -1, 1);
  const Quat q(c[0], c[1], c[2], c[3]);
  const double norm = q.norm();
  in.require(there ? std::abs(norm - 1) < 0.01 : norm == 0);
  return there && norm > 0 ? Quat(q.coeffs() / norm) : Quat::Identity();
}

}  // namespace

std::string nameOf(DeviceKind kind) { return kind == DeviceKind::kArm ? "arm" : "display"; }

std::string describeFaults(std::uint32_t faults) {
  std::string text;
  const auto add = [&](StatusFault bit, const char* name) {
    if ((faults & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(kOverTemperature, "over-temperature");
  add(kSensorFault, "sensor");
  add(kSupplyFault, "supply");
  add(kEmergencyStop, "emergency stop");
  return text;
}

Frame toFrame(const Identity& m) {
  Frame frame = frameOf(FrameType::kIdentity);
  PayloadWriter(frame.payload)
      .put(static_cast<std::uint8_t>(m.kind))
      .put(std::uint8_t{0})
      .put(m.firmware)
      .put(m.rate)
      .putText(m.model, 16)
      .putText(m.serial, 12)
      .put(static_cast<std::uint8_t>(m.linkage))
      .putScaled<std::uint16_t>(m.tip_mass.value_or(0), kMassStep, kMass)
      .putScaled<std::uint16_t>(m.tip_damping, kDampingStep, kDamping);
  return frame;
}

std::optional<Identity> identityIn(const Frame& frame) {
  if (frame.type != FrameType::kIdentity) return std::nullopt;
  PayloadReader in(frame.payload);
  Identity m;
  const auto kind = in.take<std::uint8_t>();
  in.require(kind == 1 || kind == 2);
  m.kind = static_cast<DeviceKind>(kind);
  in.require(in.take<std::uint8_t>() == 0);
  m.firmware = in.take<std::uint16_t>();
  m.rate = in.take<std::uint16_t>();
  in.require(m.rate >= 1 && m.rate <= 8000);
  m.model = in.takeText(16);
  m.serial = in.takeText(12);
  in.require(!m.model.empty() && !m.serial.empty());
  const auto linkage = in.take<std::uint8_t>();
  in.require(linkage <= static_cast<std::uint8_t>(m.kind == DeviceKind::kArm ? Linkage::kPremium : Linkage::kNotTold));
  m.linkage = static_cast<Linkage>(linkage);
  const double mass = in.takeScaled<std::uint16_t>(kMassStep, 0, kMass);
  if (mass > 0) m.tip_mass = mass;
  m.tip_damping = in.takeScaled<std::uint16_t>(kDampingStep, 0, kDamping);
  in.require(m.kind == DeviceKind::kArm || (!m.tip_mass && m.tip_damping == 0));
  return whole(in, m);
}

Frame toFrame(const ArmCommand& m) {
  Frame frame = frameOf(FrameType::kArmCommand);
  PayloadWriter(frame.payload)
      .putVector<3>(m.f_D, kMicro, kForce)
      .putScaled<std::uint16_t>(m.deadline, kDeadlineStep, 0.1)
      .put(m.arming)
      .put(static_cast<std::uint8_t>(m.signal));
  return frame;
}

std::optional<ArmCommand> armCommandIn(const Frame& frame) {
  if (frame.type != FrameType::kArmCommand) return std::nullopt;
  PayloadReader in(frame.payload);
  ArmCommand m;
  m.f_D = in.takeVector<3>(kMicro, kForce);
  m.deadline = in.takeScaled<std::uint16_t>(kDeadlineStep, kDeadlineStep, 0.1);
  m.arming = in.take<std::uint16_t>();
  m.signal = takeSignal(in);
  return whole(in, m);
}

Frame toFrame(const ArmState& m) {
  Frame frame = frameOf(FrameType::kArmState);
  const int flags = (m.valid ? kArmValid : 0) | (m.limp ? kArmLimp : 0) | (m.v_DF ? kArmVelocity : 0) |
                    (m.q_DF ? kArmGimbal : 0) | (m.switches ? kArmSwitches : 0);
  PayloadWriter out(frame.payload);
  out.put(static_cast<std::uint8_t>(flags)).put(std::uint8_t{0});
  out.putVector<3>(m.p_DF, kNano, kReach).putVector<3>(m.v_DF.value_or(Vec3::Zero()), kMicro, kSpeed);
  putGimbal(out, m.q_DF.value_or(Quat(0, 0, 0, 0)));
  out.put(m.switches.value_or(0)).put(m.arming).put(m.answers);
  return frame;
}

std::optional<ArmState> armStateIn(const Frame& frame) {
  if (frame.type != FrameType::kArmState) return std::nullopt;
  PayloadReader in(frame.payload);
  ArmState m;
  const auto flags = in.take<std::uint8_t>();
  in.require(flags <= kArmBits && in.take<std::uint8_t>() == 0);
  m.valid = (flags & kArmValid) != 0;
  m.limp = (flags & kArmLimp) != 0;
  m.p_DF = in.takeVector<3>(kNano, kReach);
  const Vec3 v = in.takeVector<3>(kMicro, kSpeed);
  const bool has_velocity = (flags & kArmVelocity) != 0, has_gimbal = (flags & kArmGimbal) != 0;
  in.require(has_velocity || v.isZero(0));
  if (has_velocity) m.v_DF = v;
  const Quat q = takeGimbal(in, has_gimbal);
  if (has_gimbal) m.q_DF = q;
  const auto switches = in.take<std::uint16_t>();
  in.require((flags & kArmSwitches) != 0 || switches == 0);
  if ((flags & kArmSwitches) != 0) m.switches = switches;
  m.arming = in.take<std::uint16_t>();
  m.answers = in.take<std::uint32_t>();
  return whole(in, m);
}

Frame toFrame(const DisplayCommand& m) {
  Frame frame = frameOf(FrameType::kDisplayCommand);
  PayloadWriter(frame.payload)
      .putVector<2>(m.place_L, kNano, kPad)
      .put(static_cast<std::uint8_t>(m.parked))
      .put(static_cast<std::uint8_t>(m.signal))
      .putScaled<std::uint16_t>(m.deadline, kDeadlineStep, 1);
  return frame;
}

std::optional<DisplayCommand> displayCommandIn(const Frame& frame) {
  if (frame.type != FrameType::kDisplayCommand) return std::nullopt;
  PayloadReader in(frame.payload);
  DisplayCommand m;
  m.place_L = in.takeVector<2>(kNano, kPad);
  m.parked = takeFlag(in);
  m.signal = takeSignal(in);
  m.deadline = in.takeScaled<std::uint16_t>(kDeadlineStep, kDeadlineStep, 1);
  return whole(in, m);
}

Frame toFrame(const DisplayState& m) {
  Frame frame = frameOf(FrameType::kDisplayState);
  const int flags = (m.valid ? kDisplayValid : 0) | (m.parked ? kDisplayParked : 0) | (m.place_L ? kDisplayPlace : 0);
  PayloadWriter(frame.payload)
      .put(static_cast<std::uint8_t>(flags))
      .put(std::uint8_t{0})
      .putVector<2>(m.place_L.value_or(Vec2::Zero()), kNano, kPad)
      .put(m.answers);
  return frame;
}

std::optional<DisplayState> displayStateIn(const Frame& frame) {
  if (frame.type != FrameType::kDisplayState) return std::nullopt;
  PayloadReader in(frame.payload);
  DisplayState m;
  const auto flags = in.take<std::uint8_t>();
  in.require(flags <= kDisplayBits && in.take<std::uint8_t>() == 0);
  m.valid = (flags & kDisplayValid) != 0;
  m.parked = (flags & kDisplayParked) != 0;
  const Vec2 place = in.takeVector<2>(kNano, kPad);
  in.require((flags & kDisplayPlace) != 0 || place.isZero(0));
  if ((flags & kDisplayPlace) != 0) m.place_L = place;
  m.answers = in.take<std::uint32_t>();
  return whole(in, m);
}

Frame toFrame(const Status& m) {
  Frame frame = frameOf(FrameType::kStatus);
  PayloadWriter(frame.payload)
      .put(static_cast<std::uint8_t>(m.state))
      .put(m.faults)
      .put(m.bad_frames)
      .put(m.missed_deadlines);
  return frame;
}

std::optional<Status> statusIn(const Frame& frame) {
  if (frame.type != FrameType::kStatus) return std::nullopt;
  PayloadReader in(frame.payload);
  Status m;
  const auto state = in.take<std::uint8_t>();
  in.require(state >= static_cast<std::uint8_t>(DeviceState::kHoming) &&
             state <= static_cast<std::uint8_t>(DeviceState::kFaulted));
  m.state = static_cast<DeviceState>(state);
  m.faults = in.take<std::uint32_t>();
  in.require(m.faults < 16);
  m.bad_frames = in.take<std::uint32_t>();
  m.missed_deadlines = in.take<std::uint32_t>();
  return whole(in, m);
}

Frame toFrame(const ArmCapabilities& m) {
  Frame frame = frameOf(FrameType::kArmCapabilities);
  const Vec3 torque = m.peak_torque.value_or(Vec3::Zero());
  PayloadWriter(frame.payload)
      .putScaled<std::uint32_t>(m.peak_force, kMicro, kForce)
      .putScaled<std::uint32_t>(m.continuous_force, kMicro, kForce)
      .putScaled<std::uint32_t>(m.resolution, kNano, kReach)
      .putScaled<std::uint32_t>(m.stiffness_limit, 1, 1e6)
      .putVector<3>(m.workspace_min_D, kNano, kReach)
      .putVector<3>(m.workspace_max_D, kNano, kReach)
      .putScaled<std::uint16_t>(torque.x(), kTorqueStep, kTorque)
      .putScaled<std::uint16_t>(torque.y(), kTorqueStep, kTorque)
      .putScaled<std::uint16_t>(torque.z(), kTorqueStep, kTorque);
  return frame;
}

std::optional<ArmCapabilities> armCapabilitiesIn(const Frame& frame) {
  if (frame.type != FrameType::kArmCapabilities) return std::nullopt;
  PayloadReader in(frame.payload);
  ArmCapabilities m;
  m.peak_force = in.takeScaled<std::uint32_t>(kMicro, kMicro, kForce);
  m.continuous_force = in.takeScaled<std::uint32_t>(kMicro, kMicro, kForce);
  m.resolution = in.takeScaled<std::uint32_t>(kNano, kNano, kReach);
  m.stiffness_limit = in.takeScaled<std::uint32_t>(1, 1, 1e6);
  m.workspace_min_D = in.takeVector<3>(kNano, kReach);
  m.workspace_max_D = in.takeVector<3>(kNano, kReach);
  Vec3 torque;
  for (int i = 0; i < 3; ++i) torque[i] = in.takeScaled<std::uint16_t>(kTorqueStep, 0, kTorque);
  const bool told = !torque.isZero(0);
  in.require(!told || torque.minCoeff() > 0);
  if (told) m.peak_torque = torque;
  in.require(m.continuous_force <= m.peak_force && (m.workspace_min_D.array() < m.workspace_max_D.array()).all());
  return whole(in, m);
}

Frame toFrame(const TactileCapabilities& m) {
  Frame frame = frameOf(FrameType::kDisplayCapabilities);
  PayloadWriter(frame.payload)
      .putScaled<std::uint32_t>(m.resolution, kNano, kPad)
      .putScaled<std::uint32_t>(m.speed, kMicro, kSpeed)
      .putScaled<std::uint32_t>(m.rate, 1, 8000)
      .putVector<2>(m.reach, kNano, kPad);
  return frame;
}

std::optional<TactileCapabilities> displayCapabilitiesIn(const Frame& frame) {
  if (frame.type != FrameType::kDisplayCapabilities) return std::nullopt;
  PayloadReader in(frame.payload);
  TactileCapabilities m;
  m.resolution = in.takeScaled<std::uint32_t>(kNano, kNano, kPad);
  m.speed = in.takeScaled<std::uint32_t>(kMicro, kMicro, kSpeed);
  m.rate = in.takeScaled<std::uint32_t>(1, 1, 8000);
  m.reach = in.takeVector<2>(kNano, kPad);
  in.require(m.reach.minCoeff() >= 0 && m.reach.maxCoeff() > 0);
  return whole(in, m);
}

Frame toFrame(const CalibrationEntry& m, FrameType type) {
  Frame frame = frameOf(type);
  PayloadWriter(frame.payload).put(m.index).put(m.count).putText(m.name, 20).putDouble(m.value);
  return frame;
}

std::optional<CalibrationEntry> calibrationIn(const Frame& frame) {
  const bool reads = frame.type == FrameType::kReadCalibration;
  if (!reads && frame.type != FrameType::kWriteCalibration && frame.type != FrameType::kCalibration)
    return std::nullopt;
  PayloadReader in(frame.payload);
  CalibrationEntry m;
  m.index = in.take<std::uint8_t>();
  m.count = in.take<std::uint8_t>();
  in.require(frame.type == FrameType::kCalibration ? m.index < m.count : m.count == 0);
  m.name = in.takeText(20);
  in.require(m.name.empty() == reads);
  m.value = in.takeDouble();
  in.require(!reads || m.value == 0);
  return whole(in, m);
}

}  // namespace pincer::devices::usb
