#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <thread>

#include "pincer/contact/io/printable.h"
#include "pincer/devices/falcon/falcon_arm.h"
#include "pincer/devices/haply/haply_host.h"
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
  std::string devices, service = "127.0.0.1:10001";
};

// Of Haply's service, asked by HTTP without a session: nothing moves, nobody is disturbed.
struct HaplyFound {
  bool answers = false;
  std::string problem;
  devices::haply::ServiceVersion version;
  devices::haply::DeviceIds devices;
};

HaplyFound findHaply(const std::string& service) {
  constexpr double kPatience = 0.2;  // [s]
  HaplyFound found;
  const auto place = devices::haply::servicePlaceOf(service);
  if (!place)
    refuseUsage(fmt::format("--service {}: it isn't HOST:PORT or HOST:PORT:EVENTS on this computer", service));
  const auto answer = devices::haply::httpGet(*place, "/devices", kPatience);
  found.answers = answer.has_value();
  if (!answer) return found;
  const auto check = devices::haply::checkService(*place, kPatience);
  found.problem = check.problem;
  found.version = check.version;
  if (answer->status == 200) found.devices = devices::haply::readDeviceIds(answer->body);
  return found;
}

void listHaply(const HaplyFound& haply) {
  for (std::size_t i = 0; i < haply.devices.count; ++i) {
    print("haply    {:<12} {:<16} {:<10} pincer devices test {} --devices haply\n", haply.devices.ids[i].view(),
          fmt::format("service {}.{}", haply.version.major, haply.version.minor), "-", haply.devices.ids[i].view());
  }
  if (!haply.problem.empty()) print("{}\n", printableMessage(haply.problem));
}

// The damping and mass that passivity builds on, of arms that tell.
std::string tipOf(const devices::ArmCapabilities& can) {
  std::string text = can.tip_mass ? fmt::format(", {:.3g} g at the tip", 1e3 * *can.tip_mass) : "";
  if (can.tip_damping > 0) text += fmt::format(", {:.3g} N s/m", can.tip_damping);
  return text;
}

void listArm(const devices::usb::UsbArm& arm) {
  const auto& can = arm.capabilities();
  print("arm      {:<12} {:<16} {:<10} {:.3g} N peak, {:.3g} N continuous, {:.3g} um, {:.3g} N/mm{}\n",
        printable(arm.deviceIdentity().serial), printable(arm.deviceIdentity().model), devices::nameOf(arm.linkState()),
        can.peak_force, can.continuous_force, 1e6 * can.resolution, 1e-3 * can.stiffness_limit, tipOf(can));
}

void listDisplay(const devices::usb::UsbDisplay& display) {
  const auto& can = display.capabilities();
  print("display  {:<12} {:<16} {:<10} +-{:.3g} x +-{:.3g} mm, {:.3g} um, {:.3g} mm/s\n",
        printable(display.deviceIdentity().serial), printable(display.deviceIdentity().model),
        devices::nameOf(display.linkState()), 1e3 * can.reach.x(), 1e3 * can.reach.y(), 1e6 * can.resolution,
        1e3 * can.speed);
}

// Found, not opened: that would take its firmware, and homing.
void listFalcon(const devices::falcon::FalconPlace& place) {
  print("falcon   {:<12} {:<16} {:<10} pincer run ... --devices falcon --arms {}\n", place.port, "Novint Falcon",
        place.serial.empty() ? "-" : printable(place.serial), place.port);
}

template <typename Device>
void writeDevice(const Device& device, const char* kind, JsonWriter& json) {
  json.beginObject().key("kind").value(kind).key("serial").value(device.deviceIdentity().serial);
  json.key("model")
      .value(device.deviceIdentity().model)
      .key("firmware")
      .value(static_cast<int>(device.deviceIdentity().firmware));
  json.key("state").value(devices::nameOf(device.linkState())).endObject();
}

void printJson(UsbHost& host, const std::vector<devices::falcon::FalconPlace>& falcons, const HaplyFound& haply) {
  JsonWriter json;
  json.beginObject().key("devices").beginArray();
  for (const auto* arm : host.arms()) writeDevice(*arm, "arm", json);
  for (const auto* display : host.displays()) writeDevice(*display, "display", json);
  for (const auto& falcon : falcons) {
    json.beginObject()
        .key("kind")
        .value("falcon")
        .key("port")
        .value(falcon.port)
        .key("serial")
        .value(falcon.serial)
        .endObject();
  }
  for (std::size_t i = 0; i < haply.devices.count; ++i)
    json.beginObject()
        .key("kind")
        .value("haply")
        .key("serial")
        .value(std::string(haply.devices.ids[i].view()))
        .endObject();
  json.endArray().key("problems").beginArray();
  if (!haply.problem.empty()) json.value(haply.problem);
  for (const std::string& problem : host.problems()) json.value(problem);
  print("{}\n", json.endArray().endObject().text());
}

int listHaplyAlone(const DevicesListArguments& arguments) {
  const HaplyFound haply = findHaply(arguments.service);
  listHaply(haply);
  if (!haply.answers)
    print("Nobody answers as Haply's service at {}. Start it: systemctl start haply-inverse-service.service\n",
          arguments.service);
  return haply.answers && haply.problem.empty() ? kExitOk : kExitDevice;
}

int listDevices(const DevicesListArguments& arguments) {
  if (arguments.devices == "haply" && !arguments.json) return listHaplyAlone(arguments);
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
  const HaplyFound haply = findHaply(arguments.service);
  if (arguments.json) {
    printJson(host, falcons, haply);
  } else {
    for (const auto* arm : host.arms()) listArm(*arm);
    for (const auto* display : host.displays()) listDisplay(*display);
    for (const auto& falcon : falcons) listFalcon(falcon);
    listHaply(haply);
    for (const std::string& problem : host.problems()) print("{}\n", printableMessage(problem));
    if (host.arms().empty() && host.displays().empty() && falcons.empty() && haply.devices.count == 0 &&
        host.problems().empty()) {
      print(
          "No device of pincer's USB protocol is plugged in. Check cable and power; `lsusb` must show 1209:0001 "
          "(docs/devices/setup.md).\n");
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
  command->add_option("--devices", arguments->devices, "Only these (default: all)")->check(CLI::IsMember({"haply"}));
  command->add_option("--service", arguments->service, "Where Haply's service is: HOST:PORT")->capture_default_str();
  command->footer("\nExample:\n  pincer devices list");
  command->callback([arguments, &exit_code] { exit_code = listDevices(*arguments); });
}

}  // namespace pincer::tasks
