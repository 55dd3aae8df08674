#include "pincer/tasks/app/device_options.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/app/interrupt.h"
#include "pincer/tasks/app/print.h"
#include "pincer/tasks/app/usage.h"
#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/servo/servo_text.h"

namespace pincer::tasks {

namespace {

extern "C" void pincerOnReportRequest(int) { requestServoReport(); }

}  // namespace

std::optional<std::string> typedLine() {
  constexpr int kLook = 100;  // for an interrupt [ms]
  std::string line;
  for (char c = 0;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&input, 1, kLook);
    if (interruptFlag()) return {};
    if (ready <= 0) continue;
    if (::read(STDIN_FILENO, &c, 1) != 1) return {};
    if (c == '\n') return line;
    line += c;
  }
}

bool lineComes() { return typedLine().has_value(); }

void addDeviceOptions(CLI::App& command, DeviceRunOptions& options) {
  command
      .add_option("--devices", options.devices,
                  "What the fingers wear: simulated devices and participant, or real ones and a person")
      ->check(CLI::IsMember({"sim", "usb", "falcon", "haply", "mouse", "replay"}))
      ->capture_default_str();
  command
      .add_option("--arms", options.which.arms,
                  "Serial numbers (of Falcons: or USB ports; of Inverse3: ids) of the arms of index finger and thumb "
                  "(default: in their order)")
      ->delimiter(',');
  command.add_option("--displays", options.which.displays, "Serial numbers of their displays")->delimiter(',');
  command
      .add_option("--watchdog", options.watchdog_ms,
                  "Of usb, falcon and haply: so long may the program stall before forces are cut; samples count for "
                  "0.6 of it, arms go limp after "
                  "0.8 [ms]")
      ->check(within({.min = 2, .max = 100, .remedy = "In milliseconds."}))
      ->default_str("5");
  command
      .add_option("--calibration", options.which.calibrations,
                  "Files of the arms' bases (pincer devices calibrate --save)")
      ->delimiter(',');
  command.add_option(
      "--recording", options.which.recording,
      "What replay replays: a session.db, or a CSV of samples as pincer export writes it; the first trial");
  command.add_option("--firmware", options.which.firmware, "The Falcon's image, out of its maker's driver");
  command
      .add_option("--grips", options.which.grips,
                  "Ids of the VerseGrips that are the handles of Inverse3, in the order of --arms")
      ->delimiter(',');
  command.add_option("--service", options.which.service, "Where Haply's service is: HOST:PORT, or HOST:PORT:EVENTS")
      ->capture_default_str();
  command
      .add_option("--force-gate", options.which.force_gate,
                  "Gain of the force gate of Haply's service (default: left as it is)")
      ->check(within({.min = 0, .max = 10, .remedy = "Its own default is 0.3."}));
  command.add_option("--pressure", options.which.pressure,
                     "HOST:PORT of WEART's Middleware: a TouchDIVER on index finger and thumb presses as the normal "
                     "forces say; no place");
  command.add_option("--pressure-hand", options.which.pressure_hand, "Which hand wears it")
      ->check(CLI::IsMember({"right", "left"}))
      ->capture_default_str();
  command.add_option("--full-pressure", options.which.full_pressure, "Normal force of its highest level [N]")
      ->check(within({.min = 0.1, .max = 100, .remedy = "The maker tells no newtons; 5 N is ours."}))
      ->capture_default_str();
  command.add_flag("--yes", options.yes, "Switch forces on without asking; nobody's hand may be in danger");
}

std::unique_ptr<HandDevices> openDevices(const DeviceRunOptions& options, ServoOptions& servo) {
  const DeviceChoice choice = deviceChoiceOf(options.devices);
  if (options.watchdog_ms && !hasMotors(choice)) {
    throw CLI::ValidationError(
        fmt::format("--watchdog {:g} guards motors, and --devices {} has none. Leave it out, or give --devices usb, "
                    "falcon or haply",
                    *options.watchdog_ms, options.devices));
  }
  if (options.watchdog_ms) servo.watchdog = 1e-3 * *options.watchdog_ms;
  servo.show = [period = 1 / servo.rate](const ServoReport& report) {
    print(stderr, "{}\n", servoText(report, period));
  };
  std::signal(SIGUSR1, pincerOnReportRequest);
  DeviceOptions which = options.which;
  which.watchdog = servo.watchdog;
  which.choice = choice;
  if (choice == DeviceChoice::kReplay && which.recording.empty())
    refuseUsage(
        "--devices replay needs the recording: --recording FILE, a session.db, or a CSV of samples (pincer export)");
  if (choice == DeviceChoice::kSim || choice == DeviceChoice::kMouse) return nullptr;
  auto devices = openHandDevices(which);
  for (const std::string& line : devices->describe()) print(stderr, "{}\n", printableMessage(line));
  servo.clock = hasMotors(choice) ? ServoClock::kReal : ServoClock::kPaced;
  return devices;
}

bool operatorArms(const DeviceRunOptions& options, const std::string& why) {
  print(stderr, "{}\n", why);
  if (options.yes) return true;
  print(
      stderr,
      "Forces are off. Fingers in place, emergency stop at hand? Enter switches forces on, Ctrl-D ends the session. ");
  return lineComes();
}

}  // namespace pincer::tasks
