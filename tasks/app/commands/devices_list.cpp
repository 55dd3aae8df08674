#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <thread>

#include "pincer/contact/io/printable.h"
#include "pincer/devices/falcon/falcon_arm.h"
#include "pincer/devices/usb/usb_host.h"
#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/devices_commands.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/process/interrupted.h"
#include "pincer/tasks/run/servo/hand_devices_parts.h"

namespace pincer::tasks {
namespace {

using devices::usb::UsbHost;

struct DevicesListArguments {
  bool json = false;
  double timeout = 1;
};

// What passivity builds on, of arms that tell.
std::string tipOf(const devices::ArmCapabilities& can) {
  std::string text = can.tip_mass ? fmt::format(", {:.3g} g at the tip", 1e3 * *can.tip_mass) : "";
  if (can.tip_damping > 0) text += fmt::format(", {:.3g} N s/m", can.tip_damping);
  return text;
}

void listArm(const devices::usb::UsbArm& arm) {
  const auto& can = arm.capabilities();
  print("arm      {:<12} {:<16} {:<10} {:.3g} N peak, {:.3g} N continuous, {:.3g} um, {:.3g} N/mm{}\n",
        printable(arm.deviceIdentity().serial), printable(arm.deviceIdentity().model), devices::nameOf(arm.linkState()), can.peak_force,
        can.continuous_force, 1e6 * can.resolution, 1e-3 * can.stiffness_limit, tipOf(can));
}

void listDisplay(const devices::usb::UsbDisplay& display) {
  const auto& can = display.capabilities();
  print("display  {:<12} {:<16} {:<10} +-{:.3g} x +-{:.3g} mm, {:.3g} um, {:.3g} mm/s\n", printable(display.deviceIdentity().serial),
        printable(display.deviceIdentity().model), devices::nameOf(display.linkState()), 1e3 * can.reach.x(), 1e3 * can.reach.y(),
        1e6 * can.resolution, 1e3 * can.speed);
}

// Found, not opened: that would take its firmware, and homing.
void listFalcon(const devices::falcon::FalconPlace& place) {
  print("falcon   {:<12} {:<16} {:<10} pincer run ... --devices falcon --arms {}\n", place.port, "Novint Falcon",
        place.serial.empty() ? "-" : printable(place.serial), place.port);
}

template <typename Device>
void writeDevice(const Device& device, const char* kind, JsonWriter& json) {
  json.beginObject().key("kind").value(kind).key("serial").value(device.deviceIdentity().serial);
  json.key("model").value(device.deviceIdentity().model).key("firmware").value(static_cast<int>(device.deviceIdentity().firmware));
  json.key("state").value(devices::nameOf(device.linkState())).endObject();
}

void printJson(UsbHost& host, const std::vector<devices::falcon::FalconPlace>& falcons) {
  JsonWriter json;
  json.beginObject().key("devices").beginArray();
  for (const auto* arm : host.arms()) writeDevice(*arm, "arm", json);
  for (const auto* display : host.displays()) writeDevice(*display, "display", json);
  for (const auto& falcon : falcons) {
    json.beginObject().key("kind").value("falcon").key("port").value(falcon.port).key("serial").value(falcon.serial).endObject();
  }
  json.endArray().key("problems").beginArray();
  for (const std::string& problem : host.problems()) json.value(problem);
  print("{}\n", json.endArray().endObject().text());
}

int listDevices(const DevicesListArguments& arguments) {
  const auto usb = startUsb();
  UsbHost& host = *usb;
  constexpr double kLook = 0.1;  // for an interrupt [s]
  bool answered = false;
  for (double waited = 0; !answered && waited < arguments.timeout; waited += kLook) {
    throwIf(interruptFlag());
    answered = host.waitFor(1, 0, kLook);
  }
  if (answered) std::this_thread::sleep_for(std::chrono::milliseconds(200));  // the others, too
  const auto falcons = devices::falcon::listFalcons();
  if (arguments.json) {
    printJson(host, falcons);
  } else {
    for (const auto* arm : host.arms()) listArm(*arm);
    for (const auto* display : host.displays()) listDisplay(*display);
    for (const auto& falcon : falcons) listFalcon(falcon);
    for (const std::string& problem : host.problems()) print("{}\n", printableMessage(problem));
    if (host.arms().empty() && host.displays().empty() && falcons.empty() && host.problems().empty()) {
      print("No device of pincer's USB protocol is plugged in. Check cable and power; `lsusb` must show 1209:0001 (docs/devices.md).\n");
    }
  }
  return host.problems().empty() ? kExitOk : kExitDevice;
}

}  // namespace

void addDevicesList(CLI::App& devices, int& exit_code) {
  auto arguments = std::make_shared<DevicesListArguments>();
  CLI::App* command = devices.add_subcommand("list", "What is plugged in, and what it can do");
  command->add_flag("--json", arguments->json, "For machines");
  command->add_option("--timeout", arguments->timeout, "For devices to answer [s]")
      ->check(within({.min = 0.1, .max = 60, .remedy = "In seconds."}))
      ->capture_default_str();
  command->footer("\nExample:\n  pincer devices list");
  command->callback([arguments, &exit_code] { exit_code = listDevices(*arguments); });
}

}  // namespace pincer::tasks
