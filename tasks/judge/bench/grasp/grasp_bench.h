// grasp_bench: `pincer bench grasp`: what fingers hold, feel and cost, each figure
// beside what pincer promises (docs/grasp.md).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

struct GraspBenchOptions {
  std::string out;  // directory for the stability map's table and plot; empty: none
};

// In the order in which a person should read them. Throws InputError.
std::vector<Measurement> graspMeasurements(const GraspBenchOptions& options);

// Its parts, one source file each.
std::vector<Measurement> holdingMeasurements();     // cone, reaction, slip onset, drift, handing over
std::vector<Measurement> softFingerMeasurements();  // limit surface, rolling
std::vector<Measurement> couplingMeasurements(const GraspBenchOptions& options);  // stiffness, energy, passivity
std::vector<Measurement> graspCostMeasurements();                                 // microseconds
std::vector<Measurement> featureCostMeasurements();                               // each feature on and off
std::vector<Measurement> baselineMeasurements();  // published methods on the same scenes

}  // namespace pincer::tasks
