// stream_link: what arms and displays have in common on USB: the latest state for the servo, and
// the servo's newest command for the device.
//
//   deadline sent = deadline asked for - age of the command
//   Nothing is sent of a command that is older than its deadline.
//
// So a command dies at the same moment whether the USB thread was held up or not: its life
// doesn't begin anew when it is sent at last.
#pragma once
#include <cstdint>

#include "pincer/devices/triple_buffer.h"
#include "pincer/devices/usb/device_link.h"
#include "pincer/devices/usb/usb_thread.h"

namespace pincer::devices::usb {

struct ArmWire {
  using State = ArmState;
  using Capabilities = ArmCapabilities;
  using Command = ArmCommand;
  static std::optional<State> stateIn(const Frame& frame) { return armStateIn(frame); }
  static std::optional<Capabilities> capabilitiesIn(const Frame& frame, const Identity& identity) {
    std::optional<Capabilities> arm = armCapabilitiesIn(frame);
    if (arm) arm->tip_mass = identity.tip_mass, arm->tip_damping = identity.tip_damping;
    return arm;
  }
};

struct DisplayWire {
  using State = DisplayState;
  using Capabilities = TactileCapabilities;
  using Command = DisplayCommand;
  static std::optional<State> stateIn(const Frame& frame) { return displayStateIn(frame); }
  static std::optional<Capabilities> capabilitiesIn(const Frame& frame, const Identity&) {
    return displayCapabilitiesIn(frame);
  }
};

template <typename Wire>
class StreamLink : public DeviceLink {
 public:
  StreamLink(Identity identity, UsbThread& usb) : DeviceLink(std::move(identity)), usb_(usb) {}

 protected:
  struct Reading {
    typename Wire::State state;
    std::int64_t sent_ns = 0;
  };

  // For the servo thread.
  const Reading& latestReading() {
    readings_.update();
    return readings_.current();
  }
  void post(const typename Wire::Command& command) {
    commands_.writable() = {command, usb_.now()};
    commands_.publish();
    usb_.wake();
  }
  // Sound from the first time that linkState() is kReady; a device keeps them, and the servo may be reading.
  const typename Wire::Capabilities& toldCapabilities() const { return capabilities_; }
  void wakeUsb() noexcept { usb_.wake(); }

  // In the USB thread, before a command goes out.
  virtual void checkCommand(typename Wire::Command&) {}

 private:
  struct Posted {
    typename Wire::Command command;
    std::int64_t asked_ns = 0;
  };

  bool takeState(const Frame& frame, std::int64_t sent) override {
    const auto state = Wire::stateIn(frame);
    if (!state) return false;
    readings_.writable() = {*state, sent};
    readings_.publish();
    answered(state->answers);
    return true;
  }
  bool takeCapabilities(const Frame& frame) override {
    const auto capabilities = Wire::capabilitiesIn(frame, deviceIdentity());
    if (!capabilities) return false;
    if (!told_capabilities_) capabilities_ = *capabilities;
    return told_capabilities_ = true;
  }
  bool takeCommand(Frame& frame, std::int64_t now) override {
    if (!commands_.update()) return false;
    const auto& [posted, asked_ns] = commands_.current();
    typename Wire::Command command = posted;
    command.deadline -= 1e-9 * static_cast<double>(now - asked_ns);
    if (command.deadline < kDeadlineStep) return false;
    checkCommand(command);
    frame = toFrame(command);
    return true;
  }

  UsbThread& usb_;
  typename Wire::Capabilities capabilities_;
  bool told_capabilities_ = false;  // USB thread only
  TripleBuffer<Reading> readings_;  // USB thread -> servo
  TripleBuffer<Posted> commands_;   // servo -> USB thread
};

}  // namespace pincer::devices::usb
