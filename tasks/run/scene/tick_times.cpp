#include "pincer/tasks/run/scene/tick_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pincer::tasks {
namespace {

constexpr std::int64_t kMostKept = 1'000'000;  // times, 8 MB: of longer runs every so many ticks one is kept

}  // namespace

TickTimes::TickTimes(std::int64_t expected_ticks)
    : stride_(std::max<std::int64_t>(1, (expected_ticks + kMostKept - 1) / kMostKept)) {
  seconds_.reserve(static_cast<std::size_t>(std::clamp<std::int64_t>(expected_ticks, 0, kMostKept)));
}

void TickTimes::add(double seconds) {
  if (seconds_.size() < kMostKept) seconds_.push_back(seconds);
}

double TickTimes::quantile(double q) const {
  if (seconds_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = seconds_;
  const double rank = std::ceil(q * static_cast<double>(sorted.size())) - 1;
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 0.0));
  std::nth_element(sorted.begin(), nth, sorted.end());
  return *nth;
}

}  // namespace pincer::tasks
