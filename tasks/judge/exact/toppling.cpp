#include "pincer/tasks/judge/exact/toppling.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {

double RockingBlock::fallTime(double tilt) const {
  using State = Vec2;  // (th, th')
  const double R = math::hypot(half_width, half_height), alpha = math::atan2(half_width, half_height);
  const auto slope = [&](double, const State& y) { return State(y[1], -0.75 * g / R * math::sin(alpha - y[0])); };
  return integrateUntil<State>({tilt, 0}, 1e-5, slope, [](const State& y) { return -y[0]; }).t;
}

double RockingBlock::angularVelocityRatio() const {
  const double alpha = math::atan2(half_width, half_height);
  return 1 - 1.5 * math::sin(alpha) * math::sin(alpha);
}

double RockingBlock::nextPeak(double tilt) const {
  const double alpha = math::atan2(half_width, half_height), e = angularVelocityRatio();
  return alpha - math::acos(math::cos(alpha) + e * e * (math::cos(alpha - tilt) - math::cos(alpha)));
}

double leastAngleOfLadder(double mu, double length, double end_radius) {
  const auto excess = [&](double th) {
    return 0.5 * length * math::cos(th) * (mu * mu - 1) + mu * length * math::sin(th) + end_radius * mu * (1 + mu);
  };
  double low = 0, high = M_PI / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return low;
}

Jam jamOfTip(double mass, double inertia, const Vec2& tip, const Vec2& v) {
  PINCER_ASSERT(mass > 0 && inertia > 0);
  const double x = tip[0], z = tip[1];
  Eigen::Matrix2d W;
  W << 1 / mass + z * z / inertia, -x * z / inertia, -x * z / inertia, 1 / mass + x * x / inertia;
  const Vec2 r = -W.inverse() * v;
  return {r, v + r / mass, (z * r[0] - x * r[1]) / inertia};  // about y: z f_x - x f_z
}

}  // namespace pincer::exact
