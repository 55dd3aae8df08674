// usb_gadget: what is at the far end of an emulated cable: packets in, packets out, time from outside.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "pincer/devices/usb/frame.h"

namespace pincer::emulation {

using Packet = devices::usb::FrameBytes;

class UsbGadget {
 public:
  virtual ~UsbGadget() = default;
  // Its device and configuration descriptors as the bus shows them, hexadecimal.
  virtual std::string descriptors() const = 0;
  virtual unsigned outEndpoint() const { return 0x01; }
  virtual std::string serialText() const { return ""; }  // string descriptor 3
  // As after it was plugged in.
  virtual void powerUp() = 0;
  virtual void received(std::span<const std::uint8_t> packet) = 0;
  virtual void advance(double dt) = 0;  // [s]
  // The next packet for the host, at endpoint 0x81; how long it is, 0: there is none.
  virtual std::size_t take(Packet& packet) = 0;
  // A vendor request without data; false: stalls.
  virtual bool control(std::uint8_t, std::uint16_t) { return false; }
};

}  // namespace pincer::emulation
