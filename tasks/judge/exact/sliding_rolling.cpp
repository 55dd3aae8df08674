#include "pincer/tasks/judge/exact/sliding_rolling.h"

#include <cmath>

namespace pincer::exact {

double Slope::acceleration() const { return g * (math::sin(theta) - mu * math::cos(theta)); }

double SlideToRoll::position(double t) const {
  const double t_roll = transitionTime();
  if (t < t_roll) return v0 * t - 0.5 * mu * g * t * t;
  return 12 * v0 * v0 / (49 * mu * g) + 5.0 / 7 * v0 * (t - t_roll);
}

double SlideToRoll::velocity(double t) const { return t < transitionTime() ? v0 - mu * g * t : 5.0 / 7 * v0; }

bool RollingIncline::rolls() const { return mu >= 2.0 / 7 * math::tan(theta); }

double RollingIncline::acceleration() const {
  return rolls() ? 5.0 / 7 * g * math::sin(theta) : g * (math::sin(theta) - mu * math::cos(theta));
}

double RollingIncline::surfaceAcceleration() const {
  return rolls() ? acceleration() : 2.5 * mu * g * math::cos(theta);
}

RolledBall rolledBetweenPlates(double radius, const Vec3& way1, const Vec3& way2) {
  return {0.5 * (way1 + way2), Vec3::UnitZ().cross(way2 - way1) / (2 * radius)};
}

double RollingResistance::creep() const {
  const double e2 = rolling_radius * rolling_radius, b = 1.4 * radius * radius - e2, c = radius * e2;
  return 2 * c / (b + std::sqrt(b * b + 4 * radius * c));
}

double RollingResistance::deceleration() const { return mu * g * creep() / math::hypot(creep(), rolling_radius); }

}  // namespace pincer::exact
