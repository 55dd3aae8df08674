// usb_display: a contact location display that speaks the protocol of docs/usb-protocol.md. A command dies in the device after
// `kPlaceDeadline`; the tactor then parks.
#pragma once
#include "devices/cld/tactile_display.h"
#include "devices/usb/device_link.h"
#include "devices/usb/mailbox.h"
#include "devices/usb/waker.h"

namespace pincer::devices::usb {

inline constexpr double kPlaceDeadline = 0.1;  // [s]

class UsbDisplay final : public TactileDisplay, public DeviceLink {
 public:
  UsbDisplay(Identity identity, Waker& waker) : DeviceLink(std::move(identity)), waker_(waker) {}

  std::string identity() const override;
  const TactileCapabilities& capabilities() const override { return capabilities_; }  // sound from the first time that state() is kReady
  DeviceState state() const override { return linkState(); }
  TactileSample sample() override;
  bool command(const TactileCommand& command) override;

 private:
  struct Reading {
    DisplayState state;
    std::int64_t sent_ns = 0;
  };

  bool takeState(const Frame& frame, std::int64_t sent) override;
  bool takeCapabilities(const Frame& frame) override;
  bool takeCommand(Frame& frame) override;

  Waker& waker_;
  TactileCapabilities capabilities_;
  bool has_capabilities_ = false;
  Mailbox<Reading> readings_;
  Mailbox<DisplayCommand> commands_;
};

}  // namespace pincer::devices::usb
