// usb_bench: what the tests of USB devices share: an emulated bus, a host on it, and a virtual clock that both follow.
#pragma once
#include <atomic>
#include <chrono>
#include <thread>

#include "pincer/devices/usb/usb_host.h"
#include "pincer/tests/emulation/emulated_bus.h"
#include "pincer/tests/emulation/firmware.h"
#include "pincer/tests/emulation/usbfs_interpose.h"

namespace pincer::tests {

// Waits for what other threads do; 20 s of the wall clock mean that it will never be.
template <typename Condition>
bool eventually(Condition condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(20));
  }
  return true;
}

// Time stands still but for advance().
class UsbBench {
 public:
  emulation::EmulatedBus bus;
  std::atomic<std::int64_t> now_ns{1'000'000'000};

  devices::usb::Clock clock() {
    return [this] { return now_ns.load(); };
  }
  void advance(double dt) {
    now_ns += static_cast<std::int64_t>(1e9 * dt);
    bus.advance(dt);
  }
  std::shared_ptr<emulation::ArmFirmware> addArm(const std::string& serial) {
    auto firmware = std::make_shared<emulation::ArmFirmware>(serial);
    bus.add(firmware);
    return firmware;
  }
  std::shared_ptr<emulation::DisplayFirmware> addDisplay(const std::string& serial) {
    auto firmware = std::make_shared<emulation::DisplayFirmware>(serial);
    bus.add(firmware);
    return firmware;
  }
};

// A host that has found everything on the bus; the clock goes on meanwhile.
inline bool findAll(UsbBench& bench, devices::usb::UsbHost& host, std::size_t arms, std::size_t displays) {
  return eventually([&] {
    bench.advance(1e-3);
    return host.waitFor(arms, displays, 1e-3);
  });
}

}  // namespace pincer::tests
