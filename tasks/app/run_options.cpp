#include "tasks/app/run_options.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>

namespace pincer::tasks {

void addRunOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--out", options.out, "New directory for session and report (default: out/TASK-DATE-TIME)");
  command.add_flag_callback(
      "--real-time", [&options] { options.servo.clock = ServoClock::kPaced; }, "At 1 kHz of the wall clock in place of as fast as it goes");
  command.add_option("--sample-rate", options.sample_rate, "Of the 1000 ticks of a second, so many are kept [Hz]")->capture_default_str();
  command.add_flag("!--no-report", options.report, "Only the session and the table");
  command.add_flag("--json", options.json, "Print the table as JSON");
}

std::string outputDirectory(const RunOptions& options, const std::string& task) {
  if (!options.out.empty()) return options.out;
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("out/{}-{:%Y%m%d-%H%M%S}", task, fmt::localtime(now));
}

}  // namespace pincer::tasks
