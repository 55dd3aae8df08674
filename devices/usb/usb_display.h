// usb_display: a contact location display that speaks the protocol of docs/usb-protocol.md. A command dies in the
// device after `kPlaceDeadline`; the tactor then parks.
#pragma once
#include "pincer/devices/cld/tactile_display.h"
#include "pincer/devices/usb/stream_link.h"

namespace pincer::devices::usb {

inline constexpr double kPlaceDeadline = 0.1;  // [s]

class UsbDisplay final : public TactileDisplay, public StreamLink<DisplayWire> {
 public:
  using StreamLink::StreamLink;

  std::string identity() const override { return nameOfDevice(); }
  const TactileCapabilities& capabilities() const override { return toldCapabilities(); }
  DeviceState state() const override { return linkState(); }
  // From the servo thread, as command.
  TactileSample sample() override;
  bool command(const TactileCommand& command) override;
};

}  // namespace pincer::devices::usb
