#include "pincer/tasks/app/commands/devices_calibrate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "pincer/contact/error.h"
#include "pincer/devices/usb/usb_host.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_commands.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::usb::DeviceLink;
using devices::usb::UsbHost;

constexpr double kPatience = 2;  // with a device [s]

DeviceLink& readyDevice(UsbHost& host, const std::string& serial) {
  DeviceLink* found = nullptr;
  waitUntil(
      [&] {
        for (auto* arm : host.arms()) found = arm->deviceIdentity().serial == serial ? arm : found;
        for (auto* display : host.displays()) found = display->deviceIdentity().serial == serial ? display : found;
        return found != nullptr && found->linkState() == devices::DeviceState::kReady;
      },
      kPatience);
  if (found != nullptr) return *found;
  throw DeviceError(fmt::format("No device {} is ready on USB. See what is there: pincer devices list", serial));
}

NamedValue assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  char* end = nullptr;
  const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0') {
    refuseUsage(fmt::format("calibrate: \"{}\" isn't NAME=VALUE. For example --set base_x=0.012.", text));
  }
  asUsage([&] { checkCalibrationValue(text.substr(0, equals), value); });
  return {text.substr(0, equals), value};
}

}  // namespace

std::vector<NamedValue> changesOf(const CalibrateArguments& arguments) {
  std::vector<NamedValue> changes;
  if (!arguments.load.empty()) {
    const DeviceCalibration file = readCalibration(arguments.load);
    if (file.serial != arguments.serial) {
      throw InputError(fmt::format("{}: it is the calibration of {}, not of {}. Load that device's file.",
                                   arguments.load, file.serial, arguments.serial));
    }
    changes.assign(file.values.begin(), file.values.end());
  }
  for (const std::string& text : arguments.set) changes.push_back(assignment(text));
  for (const auto& [name, value] : changes) checkCalibrationValue(name, value);
  return changes;
}

namespace {

void requireNames(const DeviceCalibration& kept, const std::vector<NamedValue>& changes) {
  for (const auto& [name, value] : changes) {
    if (kept.values.contains(name)) continue;
    std::vector<std::string> names;
    for (const auto& [known, unused] : kept.values) names.push_back(known);
    throw InputError(
        fmt::format("calibration: {} has no value \"{}\". It has {}.", kept.serial, name, fmt::join(names, ", ")));
  }
}

int calibrate(const CalibrateArguments& arguments) {
  if (arguments.touch) return calibrateByTouch(arguments);
  if (!arguments.calibrations.empty()) refuseUsage("--calibration goes with --touch; one arm's file is --load FILE");
  if (arguments.devices == "haply") return calibrateHaply(arguments);
  if (arguments.here || !arguments.align.empty() || !arguments.undrift.empty() || !arguments.grip.empty())
    refuseUsage("--here, --align, --undrift and --grip are of Inverse3: --devices haply");
  const std::vector<NamedValue> changes = changesOf(arguments);
  const auto usb = startUsb();
  DeviceLink& device = readyDevice(*usb, arguments.serial);
  DeviceCalibration kept = keptCalibration(device);
  if (kept.values.empty()) throw DeviceError(fmt::format("{} keeps no calibration values.", arguments.serial));
  requireNames(kept, changes);
  for (const auto& [name, value] : changes) {
    device.writeCalibration(name, value);
    if (!waitUntil([&, &name = name, &value = value] { return device.calibration()[name] == value; }, kPatience))
      throw DeviceError(fmt::format("{} didn't take {}. Unplug it, plug it in again.", arguments.serial, name));
  }
  kept = keptCalibration(device);
  for (const auto& [name, value] : kept.values) print("{:<20} {}\n", name, value);
  if (!arguments.save.empty()) writeCalibration(kept, arguments.save);
  return kExitOk;
}

}  // namespace

void addDevicesCalibrate(CLI::App& devices, int& exit_code) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      devices.add_subcommand("calibrate", "Shows, changes, saves and loads the calibration values that a device keeps");
  command->add_option("serial", arguments->serial, "Of the device: pincer devices list; of two with --touch")
      ->required();
  command->add_option("--set", arguments->set, "NAME=VALUE [m or rad]; more than once for several");
  command->add_option("--save", arguments->save, "Writes all values to this file");
  command->add_option("--load", arguments->load, "Takes all values from this file first");
  command
      ->add_option("--devices", arguments->devices, "usb keeps its values itself; those of haply are in the file alone")
      ->check(CLI::IsMember({"usb", "haply"}))
      ->capture_default_str();
  command->add_flag("--here", arguments->here, "Of haply: the middle of the workspace becomes where the arm is now");
  command->add_flag("--touch", arguments->touch,
                    "Of two haply, INDEX,THUMB: where the second stands, from knobs held together at 12 places");
  command
      ->add_option("--calibration", arguments->calibrations,
                   "With --touch: files of the two arms as they are known so far")
      ->delimiter(',');
  CLI::Option* align = command
                           ->add_option("--align", arguments->align,
                                        "Of haply: the grip's turn of now becomes this finger's in the scene")
                           ->check(CLI::IsMember({"index", "thumb"}));
  command
      ->add_option("--undrift", arguments->undrift,
                   "Of haply: this finger is held as in the scene; takes out how far the grip's yaw drifted")
      ->check(CLI::IsMember({"index", "thumb"}))
      ->excludes(align);
  command->add_option("--grip", arguments->grip, "Of haply: id of the VerseGrip that is the arm's handle");
  command->add_option("--service", arguments->service, "Where Haply's service is: HOST:PORT, or HOST:PORT:EVENTS")
      ->capture_default_str();
  command->footer("\nExample:\n  pincer devices calibrate ARM1 --set base_x=0.012 --save ARM1.json");
  command->callback([arguments, &exit_code] { exit_code = calibrate(*arguments); });
}

}  // namespace pincer::tasks
