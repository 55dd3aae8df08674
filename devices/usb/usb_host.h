// usb_host: the arms and displays on this computer's USB ports, found by asking every pincer device who it is, and
// found again after they were unplugged. A device is the same one if kind and serial number are.
#pragma once
#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "pincer/devices/usb/usb_arm.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/devices/usb/usb_display.h"
#include "pincer/devices/usb/usb_thread.h"

namespace pincer::devices::usb {

class UsbHost final : private UsbPorts, private UsbThread {
 public:
  // Starts the USB thread. Throws std::runtime_error when libusb can't start.
  explicit UsbHost(Clock clock = monotonicNs, const OpenBus& open = openUsbBus);
  ~UsbHost() override;
  UsbHost(const UsbHost&) = delete;
  UsbHost& operator=(const UsbHost&) = delete;

  // Waits until at least so many are ready, at most `timeout` [s] of the wall clock; whether they are. With nothing
  // plugged in it returns as soon as the ports have been looked at.
  bool waitFor(std::size_t arms, std::size_t displays, double timeout);
  // Devices that were ever identified, by serial number; they live as long as the host. Never in a tick.
  std::vector<UsbArm*> arms();
  std::vector<UsbDisplay*> displays();
  // Devices that can't be used, as sentences with the remedy.
  std::vector<std::string> problems();
  // Frames that came from devices not identified yet and weren't sound.
  std::int64_t strayFrames() const { return stray_; }
  // Zero of the times in all samples [ns of the clock].
  void setEpoch(std::int64_t ns);

 private:
  struct Port {
    bool open = false;
    DeviceLink* link = nullptr;
    std::int64_t next_identify = 0;
    std::uint32_t sequence = 0;
    int asked = 0;
  };

  void opened(int port, std::int64_t now) override;
  void closed(int port, std::int64_t now) override;
  void received(int port, std::span<const std::uint8_t> packet, std::int64_t now) override;
  bool toSend(int port, FrameBytes& packet, std::int64_t now) override;
  void problem(const std::string& text) override;
  void searched() override;
  void wake() noexcept override;
  std::int64_t now() const override { return clock_(); }

  void meet(Port& port, const Frame& frame, std::int64_t now);
  bool readyNow(std::size_t arms, std::size_t displays) const;
  DeviceLink* linkOf(const Identity& identity);

  const Clock clock_;
  std::array<Port, kMaxPorts> ports_;  // USB thread only
  std::atomic<std::int64_t> stray_{0};
  mutable std::mutex slow_;
  std::condition_variable changed_;
  std::map<std::string, std::unique_ptr<UsbArm>> arms_;
  std::map<std::string, std::unique_ptr<UsbDisplay>> displays_;
  std::vector<std::string> problems_;
  bool searched_ = false;
  int open_ports_ = 0;
  std::int64_t epoch_ns_ = 0;
  std::atomic<UsbBus*> waking_{nullptr};
  std::unique_ptr<UsbBus> bus_;
};

}  // namespace pincer::devices::usb
