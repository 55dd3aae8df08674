#include "pincer/tasks/judge/bench/contact_bench.h"

#include <iterator>

namespace pincer::tasks {

std::vector<Measurement> contactMeasurements(const ContactBenchOptions& options) {
  std::vector<Measurement> all;
  for (std::vector<Measurement> part :
       {strokeMeasurements(options), accuracyMeasurements(), curveMeasurements(), shadingMeasurements(options),
        fingerSceneMeasurements(options), pairMeasurements(), meshPairMeasurements(), meshDefectMeasurements(),
        costMeasurements(options)}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace pincer::tasks
