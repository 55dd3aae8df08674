// usb_bus: packets to and from every pincer device on the machine's USB ports. Implemented by usb_bus_libusb.cpp.
//
// One thread does everything: it waits for transfers, plugs and wake(); transfers are asynchronous, and what libusb
// calls back only marks them as done. A port that stalls is cleared and goes on; one whose transfers fail eight times
// in a row, or that is unplugged, is closed.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "pincer/devices/usb/frame.h"

namespace pincer::devices::usb {

using Clock = std::function<std::int64_t()>;  // monotonic [ns]; called from the USB thread too
std::int64_t monotonicNs();

// Events at the ports. Every call comes from the USB thread; `port` is a small number, used again after closed().
class UsbPorts {
 public:
  virtual ~UsbPorts() = default;
  virtual void opened(int port, std::int64_t now) = 0;
  virtual void closed(int port, std::int64_t now) = 0;
  virtual void received(int port, std::span<const std::uint8_t> packet, std::int64_t now) = 0;
  // The next packet for the port, if there is one.
  virtual bool toSend(int port, FrameBytes& packet, std::int64_t now) = 0;
  // A device that can't be used, as a sentence with the remedy.
  virtual void problem(const std::string& text) = 0;
  // All that was plugged in at the start has been opened or named as a problem.
  virtual void searched() = 0;
};

constexpr int kMaxPorts = 16;  // chosen: devices at once

// Its thread lives as long as it does.
class UsbBus {
 public:
  virtual ~UsbBus() = default;
  // There is something to send. From any thread; never waits, allocates nothing.
  virtual void wake() noexcept = 0;
};

// The ports of libusb. Throws std::runtime_error when libusb can't start.
std::unique_ptr<UsbBus> openUsbBus(UsbPorts& ports, Clock clock);
using OpenBus = std::function<std::unique_ptr<UsbBus>(UsbPorts&, Clock)>;

}  // namespace pincer::devices::usb
