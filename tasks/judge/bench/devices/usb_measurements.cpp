#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <system_error>
#include <utility>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"
#include "pincer/tasks/run/process/child_process.h"

namespace pincer::tasks {
namespace {

std::string besideThisProgram(const char* name) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? name : (self.parent_path() / name).string();
}

std::vector<std::string> tabbedCells(const std::string& line) {
  std::vector<std::string> found(1);
  for (const char c : line) {
    if (c == '\t')
      found.emplace_back();
    else if (c != '\n')
      found.back() += c;
  }
  return found;
}

// name, metric, value, unit, relation, bound
Record usbRecord(const std::vector<std::string>& c) {
  const double value = std::strtod(c[2].c_str(), nullptr), bound = std::strtod(c[5].c_str(), nullptr);
  Record record = c[4] == ">="   ? atLeast(c[1], value, c[3], bound)
                  : c[4] == "==" ? exactly(c[1], value, c[3], bound)
                                 : atMost(c[1], value, c[3], bound);
  record.name = c[0];
  return record;
}

ChildProcess started(std::vector<std::string> arguments) {
  const std::string program = arguments.front();
  try {
    return ChildProcess(std::move(arguments));
  } catch (const std::system_error& error) {
    throw InputError(
        fmt::format("bench devices: {} can't be run: {}. It is built with the tests where umockdev is installed: "
                    "tests/run --quick.",
                    program, error.code().message()));
  }
}

std::vector<Record> measureUsb(const DevicesBenchOptions& options, MeasureContext& context) {
  const std::string program = options.usb.empty() ? besideThisProgram("devices_bench") : options.usb;
  if (access(program.c_str(), X_OK) != 0) {
    throw InputError(fmt::format(
        "bench devices: {} isn't there. It is built with the tests where umockdev is installed: tests/run --quick.",
        program));
  }
  ChildProcess child = started({program, fmt::format("{}", options.seconds), fmt::format("{}", options.cycles)});
  std::vector<Record> records;
  for (std::string line; child.readLine(line, context.interrupted);) {
    const auto fields = tabbedCells(line);
    if (fields.size() == 6) records.push_back(usbRecord(fields));
    context.progress(std::min(1.0, static_cast<double>(records.size()) / 25));
  }
  const int status = child.wait(context.interrupted);
  if (records.empty() || status != 0) {
    throw InputError(
        fmt::format("bench devices: {} {} {} ended early, after {} figures (status {}); run it by hand to see why.",
                    program, options.seconds, options.cycles, records.size(), status));
  }
  return records;
}

// Every line that the program prints.
void eachLine(std::vector<std::string> arguments, MeasureContext& context,
              const std::function<void(const std::string&)>& take) {
  ChildProcess child = started(std::move(arguments));
  for (std::string line; child.readLine(line, context.interrupted);) take(line);
}

// Verdict of `pincer devices test` on its devices.
struct TestedDevices {
  int devices = 0;
  double lost = 0, unsound = 0, answered = 1;  // answered: the least share of a device's commands
};

TestedDevices testedOver(double seconds, MeasureContext& context) {
  TestedDevices tested;
  const std::vector<std::string> command{besideThisProgram("device_emulator"),
                                         besideThisProgram("pincer"),
                                         "devices",
                                         "test",
                                         "--seconds",
                                         fmt::format("{}", seconds)};
  eachLine(command, context, [&](const std::string& line) {
    const auto at = line.find(" frames, ");
    if (at == std::string::npos) return;
    long long lost = 0, unsound = 0, answers = 0, commands = 1;
    if (std::sscanf(line.c_str() + at, " frames, %lld lost, %lld unsound, %lld of %lld commands", &lost, &unsound,
                    &answers, &commands) != 4)
      return;
    ++tested.devices;
    tested.lost += static_cast<double>(lost);
    tested.unsound += static_cast<double>(unsound);
    tested.answered = std::min(tested.answered, static_cast<double>(answers) / (1000 * seconds));
  });
  return tested;
}

// From SIGSTOP of the whole program to the last motor without force, as the devices' own process
// sees it [ms]; infinite where it wasn't seen.
double msAfterSigstop(MeasureContext& context) {
  double ms = std::numeric_limits<double>::infinity();
  const std::vector<std::string> command{besideThisProgram("device_emulator"),
                                         "--stop",
                                         "0.2",
                                         besideThisProgram("pincer"),
                                         "devices",
                                         "test",
                                         "--seconds",
                                         "1.5",
                                         "--force",
                                         "0.3",
                                         "--yes"};
  eachLine(command, context, [&](const std::string& line) {
    std::sscanf(line.c_str(), "stopped: every motor without force after %lf ms", &ms);
  });
  return ms;
}

std::vector<Record> twoProcesses(MeasureContext& context) {
  const double seconds = 10;
  const TestedDevices tested = testedOver(seconds, context);
  std::array<double, 5> ms{};
  for (std::size_t i = 0; i < ms.size() && !context.interrupted(); ++i) {
    context.progress(0.4 + 0.12 * static_cast<double>(i));
    ms[i] = msAfterSigstop(context);
  }
  std::sort(ms.begin(), ms.end());
  return {exactly("devices", tested.devices, "-", 4),
          atLeast("commands answered, of 1,000 per second and device, least", tested.answered, "-", 0.95),
          exactly("frames lost", tested.lost, "-", 0),
          exactly("frames unsound", tested.unsound, "-", 0),
          atMost("SIGSTOP of the program to no force, median of 5", ms[2], "ms", 5),
          unbounded("the longest of them (this machine's pauses included)", ms[4], "ms")};
}

}  // namespace

std::vector<Measurement> usbMeasurements(const DevicesBenchOptions& options) {
  return {{"usb/two processes", twoProcesses},
          {"usb/emulated", [options](MeasureContext& context) { return measureUsb(options, context); }}};
}

}  // namespace pincer::tasks
