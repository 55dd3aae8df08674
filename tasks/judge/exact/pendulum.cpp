#include "pincer/tasks/judge/exact/pendulum.h"

#include <cmath>

#include "pincer/contact/math.h"
#include "pincer/tasks/judge/exact/runge_kutta.h"

namespace pincer::exact {

double Pendulum::angle(double start, double time) const {
  using State = Vec2;  // (th, th')
  const auto slope = [&](double, const State& y) { return State(y[1], -moment * g / inertia * math::sin(y[0])); };
  const int steps = static_cast<int>(std::lround(time / 2e-5));
  State y(start, 0);
  for (int i = 0; i < steps; ++i) y = rungeKutta(y, 0, time / steps, slope);
  return y[0];
}

double tippedAngle(double half_width, double half_height, double slope, double g, double time) {
  const double R = math::hypot(half_width, half_height), alpha = math::atan2(half_width, half_height);
  const double start = slope - alpha;
  return M_PI - Pendulum{4.0 / 3 * R * R, R, g}.angle(M_PI - start, time) - start;
}

}  // namespace pincer::exact
