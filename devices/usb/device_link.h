// device_link: one device that speaks the protocol, over the times that it is plugged in. Between the USB thread, which
// moves frames, and the servo thread, which asks for the latest and commands: neither waits for the other.
//
//   kConnecting -- identity, capabilities, status "ready", a state --> kReady;   unplugged:
//   kConnecting again;   status "faulted": kFaulted
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pincer/devices/usb/frame_order.h"
#include "pincer/devices/usb/messages.h"

namespace pincer::devices::usb {

// Counts of what came and went; read from any thread.
struct LinkCounts {
  std::int64_t accepted = 0, commands = 0;         // frames from and to the device
  std::int64_t bad = 0, duplicates = 0, late = 0;  // refused frames by cause
  std::int64_t lost = 0;                           // gaps in the sequence that no late frame has filled yet
  std::int64_t connects = 0, unplugs = 0;
  std::int64_t answers = 0;        // commands whose answer came
  std::int64_t round_trip_ns = 0;  // of the last of them, from the command to its answer
};

class DeviceLink {
 public:
  explicit DeviceLink(Identity identity) : identity_(std::move(identity)) {}
  virtual ~DeviceLink() = default;
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  const Identity& deviceIdentity() const { return identity_; }
  std::string nameOfDevice() const { return identity_.model + " " + identity_.serial; }
  DeviceState linkState() const { return state_.load(std::memory_order_acquire); }
  LinkCounts counts() const;
  Status status() const;
  // Zero of the times in samples [ns of the bus's clock].
  void setEpoch(std::int64_t ns) { epoch_ns_.store(ns, std::memory_order_relaxed); }

  // Calibration values of the device, as far as they have come; asks for the missing ones. Never in a tick.
  std::map<std::string, double> calibration();
  std::size_t calibrationSize();  // how many the device has; 0: not known yet
  // Asks the device to keep `value` under a name that it has told; false if it hasn't. Never in a tick.
  bool writeCalibration(const std::string& name, double value);

  // From the USB thread.
  bool attached() const { return attached_; }
  // `sequence`: of the last frame that was sent to it.
  virtual void attach(std::int64_t now, std::uint32_t sequence);
  virtual void detach();
  void received(const Frame& frame, std::int64_t now);
  void countBad() { ++bad_; }
  bool nextFrame(Frame& frame, std::int64_t now);

 protected:
  // A state frame that is newer than all before; false if its payload isn't sound.
  virtual bool takeState(const Frame& frame, std::int64_t sent) = 0;
  virtual bool takeCapabilities(const Frame& frame) = 0;
  // The newest command, once, unless it is too old.
  virtual bool takeCommand(Frame& frame, std::int64_t now) = 0;
  // True if a stop is to be sent, before anything else.
  virtual bool takeStop() { return false; }

  double sinceEpoch(std::int64_t ns) const {
    return 1e-9 * static_cast<double>(ns - epoch_ns_.load(std::memory_order_relaxed));
  }
  void answered(std::uint32_t sequence);

 private:
  bool takeFrame(const Frame& frame, std::int64_t now);
  bool takeCalibration(const Frame& frame);
  bool nextCalibration(Frame& frame);
  void updateState();

  const Identity identity_;
  std::atomic<DeviceState> state_{DeviceState::kConnecting};
  std::atomic<std::int64_t> epoch_ns_{0};
  std::atomic<std::int64_t> accepted_{0}, commands_{0}, bad_{0}, duplicates_{0}, late_{0}, lost_{0}, connects_{0},
      unplugs_{0}, answers_{0}, round_trip_ns_{0};

  // USB thread only.
  bool attached_ = false, has_capabilities_ = false, has_state_ = false;
  DeviceState told_ = DeviceState::kHoming;
  std::int64_t next_identify_ = 0;
  FrameOrder order_;
  ClockMap clock_;
  std::uint32_t sequence_ = 0;
  std::array<std::int64_t, 64> sent_ns_{};  // when the command of a sequence was sent, by its last six bits
  std::uint32_t last_answer_ = 0;
  std::int64_t now_ = 0;  // of the frame being taken [ns]

  mutable std::mutex slow_;  // of what follows; no tick touches it
  Status status_;
  std::map<std::uint8_t, CalibrationEntry> entries_;
  std::vector<CalibrationEntry> to_write_;
  std::size_t entry_count_ = 0;
  bool wants_calibration_ = false;
  std::int64_t asked_at_ = 0;
};

}  // namespace pincer::devices::usb
