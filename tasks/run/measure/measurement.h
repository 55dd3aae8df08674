// measurement: what `pincer verify`, `pincer stress` and `pincer bench GROUP` are made of:
// named measurements, each giving records.
//
// A command builds its list as a plain vector, in the order in which a person should read it, and hands it to
// runMeasurements (tasks/app/commands/measure_command.h):
//
//   {{"scene/s4_pinch", [](MeasureContext& c) { return std::vector{atMost("slip
//   in 60 s", slip(c), "um", 1e-6)}; }}, ...}
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/record.h"

namespace pincer::tasks {

// A running measurement's line to its caller. A long one calls progress() now and then (it costs a reading of the
// clock) and returns soon after interrupted() turned true; what it returns then isn't shown.
struct MeasureContext {
  std::function<void(double share)> progress = [](double) {};  // done of this measurement, 0 to 1
  std::function<bool()> interrupted = [] { return false; };
  bool thorough = false;  // wanted: the long version, where there is one
};

struct Measurement {
  std::string name;                                         // "contact/torus": letters, digits, - . _ and /
  std::function<std::vector<Record>(MeasureContext&)> run;  // records without a name get the measurement's
};

// True if `name` holds `pattern` somewhere; in the pattern * stands for any text and ? for one character.
bool matches(const std::string& name, const std::string& pattern);

}  // namespace pincer::tasks
