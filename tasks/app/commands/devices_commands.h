// devices_commands: the subcommands of `pincer devices`. Each adds itself to `devices`, as commands.h says.
#pragma once

namespace CLI {
class App;
}

namespace pincer::tasks {

void addDevicesList(CLI::App& devices, int& exit_code);
void addDevicesTest(CLI::App& devices, int& exit_code);
void addDevicesCalibrate(CLI::App& devices, int& exit_code);
void addDevicesEmulate(CLI::App& devices, int& exit_code);

}  // namespace pincer::tasks
