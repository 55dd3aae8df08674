#include "pincer/tests/emulation/firmware.h"

#include <algorithm>
#include <utility>

namespace pincer::emulation {
namespace {

constexpr std::size_t kReplies = 16;   // that the device keeps for a host that doesn't fetch them; the oldest go first
constexpr double kStatusPeriod = 0.1;  // [s]
constexpr double kRounding = 1e-9;     // of sums of steps [s]
constexpr double kTipMass = 0.072;     // of the bare arm where it is lightest, and its display [kg]

devices::SimArmSettings armSettings(const std::string& serial) {
  devices::SimArmSettings settings;
  settings.serial = serial;
  return settings;
}

devices::SimCldSettings displaySettings(const std::string& serial) {
  devices::SimCldSettings settings;
  settings.serial = serial;
  return settings;
}

}  // namespace

Firmware::Firmware(usb::Identity identity) : identity_(std::move(identity)) {
  status_.state = devices::DeviceState::kReady;
}

// Device, configuration, vendor interface, endpoints 0x01 and 0x81 (interrupt, 64 bytes, every frame).
std::string Firmware::descriptors() const {
  return "120100020000004009120100000101020301"
         "09022000010100C032"
         "0904000002FF000000"
         "07050103400001"
         "07058103400001";
}

void Firmware::powerUp() {
  replies_.clear();
  order_.restart();
  sequence_ = answers_ = 0;
  time_ = last_state_ = last_status_ = 0;
  status_.bad_frames = status_.missed_deadlines = 0;
}

void Firmware::setState(devices::DeviceState state, std::uint32_t faults) {
  status_.state = state;
  status_.faults = faults;
  reply(usb::toFrame(status_));
}

void Firmware::received(std::span<const std::uint8_t> packet) {
  usb::Frame frame;
  if (usb::decode(packet, frame) != usb::FrameError::kNone) {
    ++status_.bad_frames;
    return;
  }
  if (frame.type == usb::FrameType::kIdentify) order_.restart();
  if (order_.judge(frame.sequence) != usb::FrameVerdict::kNewer) {
    ++status_.bad_frames;
    return;
  }
  if (frame.type == usb::FrameType::kIdentify) return identify();
  if (frame.type == usb::FrameType::kStop) return stop();
  if (frame.type == usb::FrameType::kReadCalibration || frame.type == usb::FrameType::kWriteCalibration) {
    if (!answerCalibration(frame)) ++status_.bad_frames;
    return;
  }
  if (!command(frame)) {
    ++status_.bad_frames;
    return;
  }
  ++commands_;
  answers_ = frame.sequence;
  reply(state());
  last_state_ = time_;
}

void Firmware::identify() {
  reply(usb::toFrame(identity_));
  reply(capabilities());
  reply(usb::toFrame(status_));
  reply(state());
}

bool Firmware::answerCalibration(const usb::Frame& frame) {
  const auto asked = usb::calibrationIn(frame);
  if (!asked || asked->index >= calibration_.size()) return false;
  auto& [name, value] = calibration_[asked->index];
  if (frame.type == usb::FrameType::kWriteCalibration) {
    if (asked->name != name) return false;
    value = asked->value;
  }
  reply(usb::toFrame(usb::CalibrationEntry{asked->index, static_cast<std::uint8_t>(calibration_.size()), name, value},
                     usb::FrameType::kCalibration));
  return true;
}

void Firmware::reply(usb::Frame frame) {
  frame.sequence = ++sequence_;
  frame.time_us = static_cast<std::uint64_t>(1e6 * time_ * clock_rate_);
  if (silent_) return;
  if (replies_.size() == kReplies) replies_.pop_front();
  replies_.push_back(usb::encode(frame));
}

void Firmware::advance(double dt) {
  time_ += dt;
  advancePlant(dt);
  stream();
}

// A state once per period, unless a command was answered in it.
void Firmware::stream() {
  if (time_ - last_status_ >= kStatusPeriod) {
    last_status_ = time_;
    reply(usb::toFrame(status_));
  }
  if (time_ - last_state_ < 1.4 / identity_.rate) return;
  last_state_ = time_;
  reply(state());
}

std::size_t Firmware::take(Packet& packet) {
  if (replies_.empty()) return 0;
  packet = replies_.front();
  replies_.pop_front();
  return packet.size();
}

ArmFirmware::ArmFirmware(const std::string& serial)
    : Firmware({usb::DeviceKind::kArm, 1, 1000, "pincer emu arm", serial, usb::Linkage::kPremium, kTipMass}),
      plant_(armSettings(serial)) {
  calibration() = {{"base_x", 0.0}, {"base_y", 0.0}, {"base_z", 0.0}, {"base_turn", 0.0}};
}

void ArmFirmware::powerUp() {
  Firmware::powerUp();
  limp_ = true;
  arming_ = refused_ = 0;
  setForce(Vec3::Zero());
}

usb::Frame ArmFirmware::capabilities() const {
  devices::ArmCapabilities told = plant_.capabilities();
  if (told_torque_) told.peak_torque = told_torque_;
  return usb::toFrame(told);
}

usb::Frame ArmFirmware::state() {
  const devices::ArmSample sample = plant_.sample();
  usb::ArmState state;
  state.valid = sample.valid && sample.p_DF.allFinite();
  state.limp = limp_;
  if (state.valid) {
    state.p_DF = sample.p_DF;
    state.q_DF = sample.q_DF;
  }
  state.switches = std::uint16_t{0};
  state.arming = arming_;
  state.answers = answers_;
  const usb::Frame frame = usb::toFrame(state);
  sent_.push_back(usb::armStateIn(frame)->p_DF);
  if (sent_.size() > 64) sent_.pop_front();
  return frame;
}

bool ArmFirmware::hasSent(const Vec3& p_DF) const { return std::find(sent_.begin(), sent_.end(), p_DF) != sent_.end(); }

bool ArmFirmware::command(const usb::Frame& frame) {
  const auto m = usb::armCommandIn(frame);
  if (!m) return false;
  if (m->signal != usb::Signal::kNone) signal_ = m->signal;
  const bool takes = m->arming != 0 && m->arming != refused_;
  arming_ = m->arming;
  limp_ = !takes;
  dies_at_ = time_ + m->deadline - kRounding;
  setForce(takes ? m->f_D : Vec3::Zero());
  return true;
}

void ArmFirmware::stop() {
  if (arming_ != 0) refused_ = arming_;
  limp_ = true;
  setForce(Vec3::Zero());
}

void ArmFirmware::setForce(const Vec3& f_D) {
  force_ = f_D;
  plant_.commandForce(f_D);
}

void ArmFirmware::advancePlant(double dt) {
  plant_.advance(dt);
  if (limp_ || time_ < dies_at_) return;
  ++status_.missed_deadlines;
  stop();
}

usb::Signal ArmFirmware::takeSignal() { return std::exchange(signal_, usb::Signal::kNone); }

DisplayFirmware::DisplayFirmware(const std::string& serial)
    : Firmware({usb::DeviceKind::kDisplay, 1, 500, "pincer emu CLD", serial}), plant_(displaySettings(serial)) {
  calibration() = {{"offset_pd", 0.0}, {"offset_ru", 0.0}};
}

void DisplayFirmware::powerUp() {
  Firmware::powerUp();
  park();
}

usb::Frame DisplayFirmware::capabilities() const { return usb::toFrame(plant_.capabilities()); }

usb::Frame DisplayFirmware::state() {
  const devices::TactileSample sample = plant_.sample();
  usb::DisplayState state;
  state.valid = sample.valid;
  state.parked = parked_;
  state.place_L = sample.place_L;
  state.answers = answers_;
  return usb::toFrame(state);
}

bool DisplayFirmware::command(const usb::Frame& frame) {
  const auto m = usb::displayCommandIn(frame);
  if (!m) return false;
  parked_ = m->parked;
  dies_at_ = time_ + m->deadline - kRounding;
  plant_.command({m->parked, m->place_L});
  return true;
}

void DisplayFirmware::advancePlant(double dt) {
  plant_.advance(dt);
  if (parked_ || time_ < dies_at_) return;
  ++status_.missed_deadlines;
  park();
}

void DisplayFirmware::park() {
  parked_ = true;
  plant_.command({true, Vec2::Zero()});
}

}  // namespace pincer::emulation
