#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "pincer/tasks/app/app.h"
#include "pincer/tasks/app/commands/commands.h"
#include "pincer/tasks/app/commands/devices_commands.h"

namespace pincer::tasks {

void addDevicesCommand(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("devices", "Arms and displays: what is there, does it work, how it is calibrated");
  command->require_subcommand(1);
  addDevicesList(*command, exit_code);
  addDevicesTest(*command, exit_code);
  addDevicesCalibrate(*command, exit_code);
  addDevicesEmulate(*command, exit_code);
  command->footer("\nExample:\n  pincer devices list\n\nBefore a person wears them: docs/devices/setup.md");
}

}  // namespace pincer::tasks
