#include "pincer/tasks/judge/bench/devices/devices_bench.h"

#include <iterator>

namespace pincer::tasks {

std::vector<Measurement> deviceMeasurements(const DevicesBenchOptions& options) {
  std::vector<Measurement> all;
  for (std::vector<Measurement> part : {displayMeasurements(), armMeasurements(), gateMeasurements(),
                                        haplyMeasurements(options), weartMeasurements(), usbMeasurements(options)}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace pincer::tasks
