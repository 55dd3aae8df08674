#include "pincer/tasks/app/run_options.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <ctime>

namespace pincer::tasks {

void addRunOptions(CLI::App& command, RunOptions& options) {
  command.add_option("--out", options.out, "New directory for session and report (default: out/TASK-DATE-TIME)");
  command.add_flag_callback(
      "--real-time", [&options] { options.servo.clock = ServoClock::kPaced; },
      "At 1 kHz of the wall clock in place of as fast as it goes");
  command.add_option("--sample-rate", options.sample_rate, "Of the 1000 ticks of a second, so many are kept [Hz]")
      ->capture_default_str();
  command.add_flag("!--no-report", options.report, "Only the session and the table");
  command.add_flag("--json", options.json, "Print the table as JSON");
}

namespace {

// CLI11 would take -1 for 2^64 - 1, and 010 for 8.
std::uint64_t seedOf(const std::string& text) {
  std::uint64_t seed = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (read.ec == std::errc{} && read.ptr == text.data() + text.size() && !text.empty()) return seed;
  throw CLI::ValidationError(
      "--seed", fmt::format("{} isn't a whole number in [0, 18446744073709551615]; take for example 1", text));
}

template <class Seed>
void addSeed(CLI::App& command, Seed& seed, const std::string& what, std::uint64_t otherwise) {
  command
      .add_option_function<std::string>(
          "--seed", [&seed](const std::string& text) { seed = seedOf(text); }, what)
      ->type_name("UINT64")
      ->default_str(std::to_string(otherwise));
}

}  // namespace

void addSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& what) {
  addSeed(command, seed, what, seed);
}
void addSeedOption(CLI::App& command, std::optional<std::uint64_t>& seed, const std::string& what,
                   std::uint64_t otherwise) {
  addSeed(command, seed, what, otherwise);
}

std::string outputDirectory(const RunOptions& options, const std::string& task) {
  if (!options.out.empty()) return options.out;
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("out/{}-{:%Y%m%d-%H%M%S}", task, fmt::localtime(now));
}

}  // namespace pincer::tasks
