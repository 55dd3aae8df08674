#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "contact/error.h"
#include "tasks/bench/devices/devices_bench.h"

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

struct ClosePipe {
  void operator()(std::FILE* pipe) const noexcept { pclose(pipe); }
};

std::vector<Record> measureUsb(const DevicesBenchOptions& options, MeasureContext& context) {
  const std::string program = options.usb.empty() ? besideThisProgram("devices_bench") : options.usb;
  if (access(program.c_str(), X_OK) != 0) {
    throw InputError(
        fmt::format("bench devices: {} isn't there. It is built with the tests where umockdev is installed: tests/run --quick.", program));
  }
  const std::string command = fmt::format("'{}' {} {}", program, options.seconds, options.cycles);
  const std::unique_ptr<std::FILE, ClosePipe> pipe(popen(command.c_str(), "r"));
  std::vector<Record> records;
  std::array<char, 1024> line;
  while (pipe && std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr && !context.interrupted()) {
    const auto fields = tabbedCells(line.data());
    if (fields.size() == 6) records.push_back(usbRecord(fields));
    context.progress(std::min(1.0, static_cast<double>(records.size()) / 22));
  }
  if (records.empty()) throw InputError(fmt::format("bench devices: {} measured nothing; run it by hand to see why.", program));
  return records;
}

}  // namespace

std::vector<Measurement> usbMeasurements(const DevicesBenchOptions& options) {
  return {{"usb/emulated", [options](MeasureContext& context) { return measureUsb(options, context); }}};
}

}  // namespace pincer::tasks
