#include "pincer/tasks/judge/exact/thrown_ball.h"

#include <algorithm>
#include <cmath>

namespace pincer::exact {
namespace {

Vec3 slipOfBall(double radius, const Vec3& v, const Vec3& w) {
  const Vec3 u = v + w.cross(Vec3(0, 0, -radius));
  return {u.x(), u.y(), 0};
}

}  // namespace

Vec3 SpinningSlide::slip() const { return slipOfBall(radius, v0, w0); }

double SpinningSlide::transitionTime() const { return 2 * slip().norm() / (7 * mu * g); }

Vec3 SpinningSlide::position(double t) const {
  const Vec3 u = slip();
  const double slides = std::min(t, transitionTime());
  const Vec3 direction = u.norm() > 0 ? Vec3(u.normalized()) : Vec3(Vec3::Zero());
  return v0 * slides - 0.5 * mu * g * slides * slides * direction + (v0 - 2.0 / 7 * u) * (t - slides);
}

Vec3 ObliqueBounces::position(double t) const {
  Vec3 p = Vec3::Zero(), v = v0, w = w0;
  double flight = std::sqrt(2 * height / g), fall = flight * g;  // until the floor; the speed with which it gets there
  while (t > flight) {
    p += Vec3(v.x(), v.y(), 0) * flight;
    p.z() = -height;
    const Vec3 u = slipOfBall(radius, v, w);
    const double most = mu * (1 + restitution) * fall;
    const Vec3 kick = u.norm() > 0 ? Vec3(-std::min(most, 2.0 / 7 * u.norm()) * u.normalized()) : Vec3(Vec3::Zero());
    w += Vec3(0, 0, -radius).cross(kick) / (0.4 * radius * radius);
    v = Vec3(v.x() + kick.x(), v.y() + kick.y(), restitution * fall);
    t -= flight;
    fall = v.z();
    flight = 2 * fall / g;
  }
  return p + v * t - Vec3(0, 0, 0.5 * g * t * t);
}

}  // namespace pincer::exact
