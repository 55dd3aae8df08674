#include "pincer/tasks/view/strip_chart.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

// The next of 1, 2, 5, 10 ... times a power of ten, at or above x > 0.
double roundedUp(double x) {
  PINCER_ASSERT(x > 0);
  const double power = math::pow(10, std::floor(math::log10(x)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (x <= step * power * (1 + 1e-12)) return step * power;
  }
  return 10 * power;
}

}  // namespace

void StripChart::add(double time, std::vector<double> values) {
  for (double& value : values) {
    if (std::abs(value) < dead_) value = 0;
  }
  if (!points_.empty() && time < points_.back().time) points_.clear();
  if (!points_.empty() && time == points_.back().time) points_.pop_back();
  points_.push_back({time, std::move(values)});
  while (points_.front().time < time - kSeconds) points_.pop_front();
}

const StripChart::Point* StripChart::at(double time) const {
  const Point* found = points_.empty() ? nullptr : &points_.front();
  for (const Point& point : points_) {
    if (point.time > time) break;
    found = &point;
  }
  return found;
}

StripChart::Range StripChart::range() const {
  double low = 0, high = 0;
  for (const Point& point : points_) {
    for (const double value : point.values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (low == 0 && high == 0) return {0, dead_ > 0 ? roundedUp(10 * dead_) : 1};
  const double least = dead_ > 0 ? 10 * dead_ : 0;
  return {low < 0 ? -roundedUp(std::max(-low, least)) : 0, high > 0 ? roundedUp(std::max(high, least)) : 0};
}

}  // namespace pincer::tasks
