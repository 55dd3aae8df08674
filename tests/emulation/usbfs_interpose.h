// usbfs_interpose: an executable that contains usbfs_interpose.cpp opens, for /dev/bus/usb/..., the
// emulated device that is attached there. The unmodified libusb asks the dynamic linker for open, ioctl and
// close, and finds the executable's first.
#pragma once
#include <memory>
#include <string>

#include "pincer/tests/emulation/usbfs_device.h"

namespace pincer::emulation {

// Null: no device there.
void attachUsbfs(const std::string& node, std::shared_ptr<UsbfsDevice> device);
// As if the user had no right to open devices.
void denyUsbfs(bool deny);

}  // namespace pincer::emulation
