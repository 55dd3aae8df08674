// view_bench: `pincer bench view`: what watching costs: pictures per second without a graphics card, a snapshot's cost
// in the tick, and whether the viewer delays the servo.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct ViewBenchOptions {
  int pictures = 20;   // that are timed
  double seconds = 3;  // of the servo in real time, with and without somebody watching
};

// In the order in which a person should read them.
std::vector<Measurement> viewMeasurements(const ViewBenchOptions& options);

}  // namespace pincer::tasks
