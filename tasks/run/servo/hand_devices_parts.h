// hand_devices_parts: what openHandDevices() chooses from, one source file each.
#pragma once
#include <functional>
#include <memory>
#include <stdexcept>

#include "pincer/contact/error.h"
#include "pincer/devices/usb/usb_host.h"
#include "pincer/tasks/run/servo/hand_devices.h"

namespace pincer::tasks {

// The result of `act`. Errors without a name of their own, of a driver or of the system below it, become DeviceError.
template <class Act>
auto withDeviceErrors(const Act& act) {
  try {
    return act();
  } catch (const DeviceError&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw DeviceError(error.what());
  }
}

// The USB thread, started. Throws DeviceError where libusb can't.
std::unique_ptr<devices::usb::UsbHost> startUsb();

// Until `done`, but for `timeout` at the most [s]; whether it came true.
bool waitUntil(const std::function<bool()>& done, double timeout);
// The calibration values that the device itself keeps; none if it answers nothing for a second. Throws DeviceError
// where only a part of them comes, or one is out of range.
DeviceCalibration keptCalibration(devices::usb::DeviceLink& device);

std::unique_ptr<HandDevices> openUsbHand(const DeviceOptions& options);
std::unique_ptr<HandDevices> openFalconHand(const DeviceOptions& options);
std::unique_ptr<HandDevices> openHaplyHand(const DeviceOptions& options);
std::unique_ptr<HandDevices> openReplayHand(const DeviceOptions& options);
// The same hand with a TouchDIVER besides.
std::unique_ptr<HandDevices> openPressedHand(std::unique_ptr<HandDevices> hand, const DeviceOptions& options);

}  // namespace pincer::tasks
