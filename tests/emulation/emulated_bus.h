// emulated_bus: USB devices that can be plugged in and pulled out, for the unmodified libusb of this process. umockdev
// shows them in sysfs and tells of plugs; usbfs_interpose answers for their nodes in /dev.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "pincer/tests/emulation/usbfs_device.h"

namespace pincer::emulation {

class EmulatedBus {
 public:
  EmulatedBus();
  ~EmulatedBus();
  EmulatedBus(const EmulatedBus&) = delete;
  EmulatedBus& operator=(const EmulatedBus&) = delete;

  // Why there can be no emulation here; empty where there can.
  static std::string obstacle();

  // A device, plugged in. Its number.
  int add(std::shared_ptr<UsbGadget> gadget);
  void unplug(int device);
  void plug(int device);
  // Makes the device of the next plugging in, so that faults can be put at its first transfers.
  void prepare(int device);
  UsbfsDevice& device(int device) { return *slots_[static_cast<std::size_t>(device)].device; }
  // Descriptors that the device shows from its next plugging in on; hexadecimal. Empty: its own.
  void setDescriptors(int device, const std::string& hex) {
    slots_[static_cast<std::size_t>(device)].descriptors = hex;
  }

  // All devices' time; in steps of the caller's, or as the wall clock goes, every millisecond.
  void advance(double dt);
  // `each`: called after every step.
  void runInRealTime(std::function<void()> each = {});
  void stopRealTime();

 private:
  struct Slot {
    std::shared_ptr<UsbGadget> gadget;
    std::shared_ptr<UsbfsDevice> device;
    std::string node, path, descriptors;
    bool plugged = false, prepared = false;
  };
  struct Testbed;

  std::unique_ptr<Testbed> testbed_;
  std::vector<Slot> slots_;
  int next_address_ = 2;
  std::atomic<bool> running_{false};
  std::thread thread_;
};

}  // namespace pincer::emulation
