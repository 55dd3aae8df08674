// thread_bus: a UsbBus without USB: a thread of its own carries packets between the host and emulated devices, in real
// time. It is told of something to send by a flag that orders nothing, so that what the host's threads share has to be
// in order by itself: a sanitizer can tell.
#pragma once
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tests/emulation/usb_gadget.h"

namespace pincer::tests {

// The devices that are plugged in; set from any thread.
struct ThreadBusPlugs {
  std::vector<std::shared_ptr<emulation::UsbGadget>> gadgets;
  std::atomic<unsigned> plugged{~0u};  // bit per gadget
};

class ThreadBus final : public devices::usb::UsbBus {
 public:
  ThreadBus(devices::usb::UsbPorts& ports, devices::usb::Clock clock, ThreadBusPlugs& plugs)
      : ports_(ports), clock_(std::move(clock)), plugs_(plugs), slots_(plugs.gadgets.size()), thread_([this] {
          run();
        }) {}
  ~ThreadBus() override {
    stop_ = true;
    thread_.join();
  }
  ThreadBus(const ThreadBus&) = delete;
  ThreadBus& operator=(const ThreadBus&) = delete;
  void wake() noexcept override { woken_.store(true, std::memory_order_relaxed); }

 private:
  void run() {
    for (bool first = true; !stop_; first = false) {
      for (std::size_t i = 0; i < slots_.size(); ++i) serve(i);
      if (first) ports_.searched();
      for (int turn = 0; turn < 10 && !woken_.exchange(false, std::memory_order_relaxed); ++turn)
        std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i].open) ports_.closed(static_cast<int>(i), clock_());
    }
  }
  void serve(std::size_t i) {
    const int port = static_cast<int>(i);
    emulation::UsbGadget& gadget = *plugs_.gadgets[i];
    Slot& slot = slots_[i];
    const bool plugged = ((plugs_.plugged.load() >> i) & 1) != 0;
    if (std::exchange(slot.open, plugged) != plugged) {
      if (!plugged) return ports_.closed(port, clock_());
      gadget.powerUp();
      slot.time_ns = clock_();
      ports_.opened(port, slot.time_ns);
    }
    if (!plugged) return;
    const std::int64_t before = std::exchange(slot.time_ns, clock_());
    gadget.advance(1e-9 * static_cast<double>(slot.time_ns - before));
    emulation::Packet packet;
    while (ports_.toSend(port, packet, clock_())) gadget.received(packet);
    while (const std::size_t size = gadget.take(packet)) ports_.received(port, std::span(packet).first(size), clock_());
  }
  struct Slot {
    bool open = false;
    std::int64_t time_ns = 0;  // that the gadget has reached
  };

  devices::usb::UsbPorts& ports_;
  devices::usb::Clock clock_;
  ThreadBusPlugs& plugs_;
  std::vector<Slot> slots_;  // the thread's
  std::atomic<bool> woken_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace pincer::tests
