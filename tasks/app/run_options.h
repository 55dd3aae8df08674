// run_options: what every experiment of `pincer run` is asked in the same way.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "pincer/tasks/run/servo/servo.h"

namespace CLI {
class App;
}

namespace pincer::tasks {

struct RunOptions {
  std::string out;  // empty: a fresh directory, named after task and time
  ServoOptions servo;
  int sample_rate = 200;  // of the ticks that are kept [Hz]
  bool report = true, json = false;
};

// Adds --out, --real-time, --sample-rate, --no-report and --json.
void addRunOptions(CLI::App& command, RunOptions& options);

// --seed: all 64 bits, in decimal digits; anything else is a usage error. Without it
// `seed` stays as it is; `what` says of what.
void addSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& what);
// Without it, nothing; `otherwise` is shown as the default.
void addSeedOption(CLI::App& command, std::optional<std::uint64_t>& seed, const std::string& what,
                   std::uint64_t otherwise);

// The session's directory; the one asked for, or out/TASK-DATE-TIME.
std::string outputDirectory(const RunOptions& options, const std::string& task);

}  // namespace pincer::tasks
