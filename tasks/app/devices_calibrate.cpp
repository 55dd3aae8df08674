#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "contact/error.h"
#include "devices/usb/usb_host.h"
#include "tasks/app/app.h"
#include "tasks/app/devices_commands.h"
#include "tasks/servo/device_calibration.h"
#include "tasks/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::usb::DeviceLink;
using devices::usb::UsbHost;

struct CalibrateArguments {
  std::string serial, save, load;
  std::vector<std::string> set;
};

bool waitUntil(const std::function<bool()>& done) {
  for (int i = 0; i < 400; ++i) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

DeviceLink& readyDevice(UsbHost& host, const std::string& serial) {
  DeviceLink* found = nullptr;
  waitUntil([&] {
    for (auto* arm : host.arms()) found = arm->deviceIdentity().serial == serial ? arm : found;
    for (auto* display : host.displays()) found = display->deviceIdentity().serial == serial ? display : found;
    return found != nullptr && found->linkState() == devices::DeviceState::kReady;
  });
  if (found != nullptr) return *found;
  throw DeviceError(fmt::format("No device {} is ready on USB. See what is there: pincer devices list", serial));
}

std::map<std::string, double> valuesOf(DeviceLink& device) {
  std::map<std::string, double> values;
  const bool whole = waitUntil([&] {
    values = device.calibration();
    return device.calibrationSize() > 0 && values.size() == device.calibrationSize();
  });
  if (!whole)
    throw DeviceError(fmt::format("{} doesn't tell its calibration. Unplug it, plug it in again.", device.deviceIdentity().serial));
  return values;
}

void changeValue(DeviceLink& device, const std::string& name, double value) {
  checkCalibrationValue(name, value);
  const auto values = valuesOf(device);
  const auto found = values.find(name);
  if (found == values.end()) {
    throw InputError(fmt::format("calibration: {} has no value \"{}\". See which it has: pincer devices calibrate {}",
                                 device.deviceIdentity().serial, name, device.deviceIdentity().serial));
  }
  const auto index = static_cast<std::uint8_t>(std::distance(values.begin(), found));
  device.writeCalibration({index, 0, name, value});
  if (!waitUntil([&] { return device.calibration()[name] == value; })) {
    throw DeviceError(fmt::format("{} didn't take {}. Unplug it, plug it in again.", device.deviceIdentity().serial, name));
  }
}

std::pair<std::string, double> assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  char* end = nullptr;
  const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0') {
    throw InputError(fmt::format("calibrate: \"{}\" isn't NAME=VALUE. For example --set base_x=0.012.", text));
  }
  return {text.substr(0, equals), value};
}

int calibrate(const CalibrateArguments& arguments) {
  const auto usb = startUsb();
  UsbHost& host = *usb;
  DeviceLink& device = readyDevice(host, arguments.serial);
  if (!arguments.load.empty()) {
    const DeviceCalibration file = readCalibration(arguments.load);
    if (file.serial != arguments.serial) {
      throw InputError(fmt::format("{}: it is the calibration of {}, not of {}.", arguments.load, file.serial, arguments.serial));
    }
    for (const auto& [name, value] : file.values) changeValue(device, name, value);
  }
  for (const std::string& text : arguments.set) {
    const auto [name, value] = assignment(text);
    changeValue(device, name, value);
  }
  const auto values = valuesOf(device);
  for (const auto& [name, value] : values) fmt::print("{:<20} {}\n", name, value);
  if (!arguments.save.empty()) writeCalibration({arguments.serial, values}, arguments.save);
  return kExitOk;
}

}  // namespace

void addDevicesCalibrate(CLI::App& devices, int& exit_code) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = devices.add_subcommand("calibrate", "Shows, changes, saves and loads a device's calibration values");
  command->add_option("serial", arguments->serial, "Of the device: pincer devices list")->required();
  command->add_option("--set", arguments->set, "NAME=VALUE [m or rad]; more than once for several");
  command->add_option("--save", arguments->save, "Writes all values to this file");
  command->add_option("--load", arguments->load, "Takes all values from this file first");
  command->footer("\nExample:\n  pincer devices calibrate ARM1 --set base_x=0.012 --save ARM1.json");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace pincer::tasks
