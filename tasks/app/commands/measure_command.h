// measure_command: what all measuring commands share: their options, and running the measurements that these select.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace CLI {
class App;
}

namespace pincer::tasks {

struct MeasureOptions {
  bool json = false;
  bool list = false;
  bool thorough = false;               // see MeasureContext
  std::vector<std::string> only = {};  // patterns (matches()); none: all
};

// --json, --list and --only.
void addMeasureOptions(CLI::App& command, MeasureOptions& options);

// Prints table or JSON (or the names) and gives the program's exit code: 1 if any record isn't ok, 5 after Ctrl-C.
// `title` leads the progress line on standard error. A measurement that throws InputError gives a record that says so
// and isn't ok. Throws InputError where a pattern selects nothing.
int runMeasurements(const std::vector<Measurement>& measurements, const MeasureOptions& options,
                    const std::string& title);

}  // namespace pincer::tasks
