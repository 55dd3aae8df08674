#include "pincer/devices/usb/device_link.h"

#include <algorithm>

namespace pincer::devices::usb {
namespace {

constexpr std::int64_t kIdentifyPeriod = 50'000'000;     // [ns]
constexpr std::int64_t kCalibrationPeriod = 20'000'000;  // [ns]
constexpr int kBeganAnew = 50;  // refused frames in a row after which the device is asked again who it is

}  // namespace

LinkCounts DeviceLink::counts() const {
  return {accepted_, commands_, bad_, duplicates_, late_, lost_, connects_, unplugs_, answers_, round_trip_ns_};
}

Status DeviceLink::status() const {
  const std::lock_guard lock(slow_);
  return status_;
}

std::map<std::string, double> DeviceLink::calibration() {
  const std::lock_guard lock(slow_);
  wants_calibration_ = true;
  std::map<std::string, double> values;
  for (const auto& [index, entry] : entries_) values[entry.name] = entry.value;
  return values;
}

std::size_t DeviceLink::calibrationSize() {
  const std::lock_guard lock(slow_);
  return entry_count_;
}

// Forgotten here until the device says what it keeps.
bool DeviceLink::writeCalibration(const std::string& name, double value) {
  const std::lock_guard lock(slow_);
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const auto& e) { return e.second.name == name; });
  if (found == entries_.end()) return false;
  to_write_.push_back({found->first, 0, name, value});
  entries_.erase(found);
  return true;
}

void DeviceLink::attach(std::int64_t now, std::uint32_t sequence) {
  attached_ = true;
  sequence_ = sequence;
  has_capabilities_ = has_state_ = false;
  told_ = DeviceState::kHoming;
  next_identify_ = now + kIdentifyPeriod;
  order_.restart();
  clock_.restart();
  ++connects_;
  updateState();
}

void DeviceLink::detach() {
  attached_ = false;
  ++unplugs_;
  updateState();
}

void DeviceLink::received(const Frame& frame, std::int64_t now) {
  if (frame.type == FrameType::kIdentity) {  // the answer to kIdentify: both sequences begin anew
    if (const auto identity = identityIn(frame); !identity || *identity != identity_) return countBad();
    order_.restart();
    clock_.restart();
  }
  switch (order_.judge(frame.sequence)) {
    case FrameVerdict::kNewer:
      lost_ += order_.lost();
      takeFrame(frame, now) ? ++accepted_ : ++bad_;
      break;
    case FrameVerdict::kDuplicate:
      ++duplicates_;
      break;
    case FrameVerdict::kLate:
      lost_ += order_.lost();
      ++late_;
      if (order_.refusedInARow() >= kBeganAnew) has_capabilities_ = false;
      break;
  }
  updateState();
}

bool DeviceLink::takeFrame(const Frame& frame, std::int64_t now) {
  now_ = now;
  const std::int64_t sent = clock_.sentAt(frame.time_us, now);
  switch (frame.type) {
    case FrameType::kIdentity:
      return true;
    case FrameType::kArmState:
    case FrameType::kDisplayState:
      if (!takeState(frame, sent)) return false;
      return has_state_ = true;
    case FrameType::kArmCapabilities:
    case FrameType::kDisplayCapabilities:
      if (!takeCapabilities(frame)) return false;
      return has_capabilities_ = true;
    case FrameType::kStatus:
      if (const auto status = statusIn(frame)) {
        told_ = status->state;
        const std::lock_guard lock(slow_);
        status_ = *status;
        return true;
      }
      return false;
    default:
      return takeCalibration(frame);
  }
}

bool DeviceLink::takeCalibration(const Frame& frame) {
  const auto entry = frame.type == FrameType::kCalibration ? calibrationIn(frame) : std::nullopt;
  if (!entry) return false;
  const std::lock_guard lock(slow_);
  entry_count_ = entry->count;
  entries_[entry->index] = *entry;
  return true;
}

void DeviceLink::updateState() {
  DeviceState state = DeviceState::kConnecting;
  if (attached_ && has_capabilities_)
    state = told_ == DeviceState::kReady && !has_state_ ? DeviceState::kHoming : told_;
  state_.store(state, std::memory_order_release);
}

void DeviceLink::answered(std::uint32_t sequence) {
  if (sequence == last_answer_ || sequence_ - sequence >= sent_ns_.size()) return;
  last_answer_ = sequence;
  round_trip_ns_ = now_ - sent_ns_[sequence % sent_ns_.size()];
  ++answers_;
}

// Commands that were missed are not caught up: only the newest goes out.
bool DeviceLink::nextFrame(Frame& frame, std::int64_t now) {
  frame = Frame{};
  const auto fill = [&] {
    if (takeStop()) {
      frame.type = FrameType::kStop;
      return true;
    }
    if (!has_capabilities_ && now >= next_identify_) {
      next_identify_ = now + kIdentifyPeriod;
      frame.type = FrameType::kIdentify;
      return true;
    }
    if (takeCommand(frame, now)) return true;
    if (now - asked_at_ < kCalibrationPeriod || !nextCalibration(frame)) return false;
    asked_at_ = now;
    return true;
  };
  if (!fill()) return false;
  frame.sequence = ++sequence_;
  frame.time_us = static_cast<std::uint64_t>(now / 1000);
  sent_ns_[frame.sequence % sent_ns_.size()] = now;
  ++commands_;
  return true;
}

bool DeviceLink::nextCalibration(Frame& frame) {
  const std::lock_guard lock(slow_);
  if (!to_write_.empty()) {
    frame = toFrame(to_write_.back(), FrameType::kWriteCalibration);
    to_write_.pop_back();
    return true;
  }
  if (!wants_calibration_) return false;
  for (std::size_t i = 0; i < std::max<std::size_t>(1, entry_count_); ++i) {
    if (entries_.count(static_cast<std::uint8_t>(i)) != 0) continue;
    frame = toFrame(CalibrationEntry{static_cast<std::uint8_t>(i), 0, "", 0}, FrameType::kReadCalibration);
    return true;
  }
  return false;
}

}  // namespace pincer::devices::usb
