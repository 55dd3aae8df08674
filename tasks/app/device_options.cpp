#include "tasks/app/device_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "contact/printable.h"
#include "tasks/app/servo_text.h"
#include "tasks/app/usage.h"
#include "tasks/scene/strict_json.h"

namespace pincer::tasks {

namespace {

extern "C" void pincerOnReportRequest(int) { requestServoReport(); }

}  // namespace

void addDeviceOptions(CLI::App& command, DeviceRunOptions& options) {
  command.add_option("--devices", options.devices, "What the fingers wear: simulated devices and participant, or real ones and a person")
      ->check(CLI::IsMember({"sim", "usb", "falcon", "mouse", "replay"}))
      ->capture_default_str();
  command
      .add_option("--arms", options.which.arms,
                  "Serial numbers (of Falcons: or USB ports) of the arms of index finger and thumb (default: in their order)")
      ->delimiter(',');
  command.add_option("--displays", options.which.displays, "Serial numbers of their displays")->delimiter(',');
  command
      .add_option("--watchdog", options.watchdog_ms,
                  "So long may the program stall before forces are cut; samples count for 0.6 of it, arms go limp after 0.8 [ms]; a mouse "
                  "has no motors: 100")
      ->check(within({.min = 2, .max = 100, .remedy = "In milliseconds."}))
      ->capture_default_str();
  command.add_option("--calibration", options.which.calibrations, "Files of the arms' bases (pincer devices calibrate --save)")
      ->delimiter(',');
  command.add_option("--recording", options.which.recording,
                     "What replay replays: a session.db, or a CSV of samples as pincer export writes it; the first trial");
  command.add_option("--firmware", options.which.firmware, "The Falcon's image, out of its maker's driver");
  command.add_flag("--yes", options.yes, "Switch forces on without asking; nobody's hand may be in danger");
}

std::unique_ptr<HandDevices> openDevices(const DeviceRunOptions& options, ServoOptions& servo) {
  servo.watchdog = 1e-3 * options.watchdog_ms;
  servo.show = [period = 1 / servo.rate](const ServoReport& report) { fmt::print(stderr, "{}\n", servoText(report, period)); };
  std::signal(SIGUSR1, pincerOnReportRequest);
  DeviceOptions which = options.which;
  which.watchdog = servo.watchdog;
  which.choice = deviceChoiceOf(options.devices);
  if (which.choice == DeviceChoice::kReplay && which.recording.empty())
    refuseUsage("--devices replay needs the recording: --recording FILE, a session.db, or a CSV of samples (pincer export)");
  if (which.choice == DeviceChoice::kSim) return nullptr;
  auto devices = openHandDevices(which);
  for (const std::string& line : devices->describe()) fmt::print(stderr, "{}\n", printableMessage(line));
  servo.real_time = true;
  return devices;
}

bool operatorArms(const DeviceRunOptions& options, const std::string& why) {
  fmt::print(stderr, "{}\n", why);
  if (options.yes) return true;
  fmt::print(stderr, "Forces are off. Fingers in place, emergency stop at hand? Enter switches forces on, Ctrl-D ends the session. ");
  std::string line;
  return static_cast<bool>(std::getline(std::cin, line));
}

}  // namespace pincer::tasks
