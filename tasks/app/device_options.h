// device_options: which devices a session runs on, as its user asks for them, and
// the operator who switches the forces on.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tasks/run/servo/servo.h"

namespace CLI {
class App;
}

namespace pincer::tasks {

struct DeviceRunOptions {
  std::string devices = "sim";
  DeviceOptions which;
  std::optional<double> watchdog_ms;  // 5
  bool yes = false;
};

// Adds --devices, --arms, --displays, --watchdog, --recording, --firmware, --grips, --service,
// --force-gate, --pressure, --pressure-hand,
// --full-pressure and --yes.
void addDeviceOptions(CLI::App& command, DeviceRunOptions& options);

// Null for those that aren't opened here: simulated ones and the mouse. Says what was found; makes
// `servo` one by the wall clock, watched where there are motors. Throws DeviceError, and
// CLI::ValidationError for a watchdog that would guard no motor.
std::unique_ptr<HandDevices> openDevices(const DeviceRunOptions& options, ServoOptions& servo);

// Waits for a line on standard input. False where the input ends, or the user interrupts.
bool lineComes();
std::optional<std::string> typedLine();  // likewise, and what it says

// Asks on the terminal whether forces may come on, because `why`; yes if the user said
// --yes. False when there is nobody to ask.
bool operatorArms(const DeviceRunOptions& options, const std::string& why);

}  // namespace pincer::tasks
