#include "pincer/tasks/run/servo/hand_devices.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {

DeviceChoice deviceChoiceOf(const std::string& name) {
  constexpr std::array kNames{"sim", "usb", "falcon", "haply", "mouse", "replay"};  // by DeviceChoice
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i]) return static_cast<DeviceChoice>(i);
  }
  throw InputError(
      fmt::format("devices \"{}\" are unknown. They are one of sim, usb, falcon, haply, mouse, replay.", name));
}

bool hasMotors(DeviceChoice choice) {
  return choice == DeviceChoice::kUsb || choice == DeviceChoice::kFalcon || choice == DeviceChoice::kHaply;
}

namespace {

std::unique_ptr<HandDevices> openArms(const DeviceOptions& options) {
  switch (options.choice) {
    case DeviceChoice::kUsb:
      return openUsbHand(options);
    case DeviceChoice::kSim:
      throw DeviceError(
          "Simulated devices are worn by a simulated participant; a session opens them by itself. Leave out "
          "--devices.");
    case DeviceChoice::kMouse:
      throw DeviceError("The mouse moves fingers in the viewer only: add --view.");
    case DeviceChoice::kFalcon:
      return openFalconHand(options);
    case DeviceChoice::kHaply:
      return openHaplyHand(options);
    case DeviceChoice::kReplay:
      return openReplayHand(options);
  }
  throw DeviceError("unknown devices");
}

}  // namespace

std::unique_ptr<HandDevices> openHandDevices(const DeviceOptions& options) {
  auto hand = openArms(options);
  return options.pressure.empty() ? std::move(hand) : openPressedHand(std::move(hand), options);
}

}  // namespace pincer::tasks
