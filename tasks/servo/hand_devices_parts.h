// hand_devices_parts: what openHandDevices() chooses from, one source file each.
#pragma once
#include <memory>

#include "devices/usb/usb_host.h"
#include "tasks/servo/hand_devices.h"

namespace pincer::tasks {

// The USB thread, started. Throws DeviceError where libusb can't.
std::unique_ptr<devices::usb::UsbHost> startUsb();

std::unique_ptr<HandDevices> openUsbHand(const DeviceOptions& options);
std::unique_ptr<HandDevices> openFalconHand(const DeviceOptions& options);
std::unique_ptr<HandDevices> openReplayHand(const DeviceOptions& options);

}  // namespace pincer::tasks
