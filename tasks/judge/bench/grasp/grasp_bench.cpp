#include "pincer/tasks/judge/bench/grasp/grasp_bench.h"

#include <iterator>

namespace pincer::tasks {

std::vector<Measurement> graspMeasurements(const GraspBenchOptions& options) {
  std::vector<Measurement> all;
  for (std::vector<Measurement> part : {holdingMeasurements(), softFingerMeasurements(), couplingMeasurements(options),
                                        baselineMeasurements(), graspCostMeasurements(), featureCostMeasurements()}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace pincer::tasks
