// run_options: what every experiment of `pincer run` is asked in the same way.
#pragma once
#include <string>

#include "tasks/servo/servo.h"

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

// The session's directory; the one asked for, or out/TASK-DATE-TIME.
std::string outputDirectory(const RunOptions& options, const std::string& task);

}  // namespace pincer::tasks
