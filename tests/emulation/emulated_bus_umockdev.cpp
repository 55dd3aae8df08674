#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <umockdev.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "pincer/tests/emulation/emulated_bus.h"
#include "pincer/tests/emulation/usbfs_interpose.h"

namespace pincer::emulation {
namespace {

void require(bool ok, GError* error, const char* what) {
  if (ok) return;
  const std::string message = std::string(what) + ": " + (error != nullptr ? error->message : "failed");
  g_clear_error(&error);
  throw std::runtime_error(message);
}

}  // namespace

struct EmulatedBus::Testbed {
  UMockdevTestbed* testbed = umockdev_testbed_new();
  ~Testbed() { g_object_unref(testbed); }
};

// Only with a testbed is umockdev in effect, if it is linked in.
std::string EmulatedBus::obstacle() {
  const Testbed testbed;
  return umockdev_in_mock_environment()
             ? ""
             : "umockdev's preload library isn't in effect here, so no device can be emulated";
}

EmulatedBus::EmulatedBus() : testbed_(std::make_unique<Testbed>()) {}

EmulatedBus::~EmulatedBus() {
  stopRealTime();
  for (std::size_t i = 0; i < slots_.size(); ++i) unplug(static_cast<int>(i));
}

int EmulatedBus::add(std::shared_ptr<UsbGadget> gadget) {
  Slot slot;
  slot.gadget = std::move(gadget);
  slot.path = fmt::format("/devices/pci0000:00/0000:00:14.0/usb1/1-{}", slots_.size() + 1);
  slots_.push_back(std::move(slot));
  const int device = static_cast<int>(slots_.size()) - 1;
  plug(device);
  return device;
}

void EmulatedBus::prepare(int device) {
  Slot& slot = slots_[static_cast<std::size_t>(device)];
  slot.device = std::make_shared<UsbfsDevice>(slot.gadget);
  slot.prepared = true;
}

void EmulatedBus::plug(int device) {
  Slot& slot = slots_[static_cast<std::size_t>(device)];
  if (slot.plugged) return;
  const int address = next_address_;
  next_address_ = next_address_ == 120 ? 2 : next_address_ + 1;  // as Linux counts them up
  slot.gadget->powerUp();
  if (!slot.prepared) prepare(device);
  slot.prepared = false;
  slot.node = fmt::format("/dev/bus/usb/001/{:03}", address);
  attachUsbfs(slot.node, slot.device);
  const std::string description = fmt::format(
      "P: {}\nN: bus/usb/001/{:03}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM={:03}\nE: "
      "DEVNAME=/dev/bus/usb/001/{:03}\n"
      "E: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum={}\\n\nA: speed=12\\n\n"
      "H: descriptors={}\n",
      slot.path, address, address, address, address,
      slot.descriptors.empty() ? slot.gadget->descriptors() : slot.descriptors);
  GError* error = nullptr;
  require(umockdev_testbed_add_from_string(testbed_->testbed, description.c_str(), &error) != 0, error,
          "emulated device");
  slot.plugged = true;
  umockdev_testbed_uevent(testbed_->testbed, ("/sys" + slot.path).c_str(), "add");
}

void EmulatedBus::unplug(int device) {
  Slot& slot = slots_[static_cast<std::size_t>(device)];
  if (!slot.plugged) return;
  slot.plugged = false;
  slot.device->unplug();
  attachUsbfs(slot.node, nullptr);
  umockdev_testbed_uevent(testbed_->testbed, ("/sys" + slot.path).c_str(), "remove");
  umockdev_testbed_remove_device(testbed_->testbed, ("/sys" + slot.path).c_str());
}

void EmulatedBus::advance(double dt) {
  for (Slot& slot : slots_) {
    if (slot.plugged) slot.device->advance(dt);
  }
}

void EmulatedBus::runInRealTime(std::function<void()> each) {
  running_ = true;
  thread_ = std::thread([this, each = std::move(each)] {
    const sched_param priority{.sched_priority = 81};  // a device doesn't wait for this computer, if that is permitted
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
    for (auto due = std::chrono::steady_clock::now(); running_;) {
      due += std::chrono::milliseconds(1);
      std::this_thread::sleep_until(due);
      for (Slot& slot : slots_) {
        if (slot.plugged) slot.device->catchUp();
      }
      if (each) each();
    }
  });
}

void EmulatedBus::stopRealTime() {
  running_ = false;
  if (thread_.joinable()) thread_.join();
}

}  // namespace pincer::emulation
