#include "pincer/tasks/judge/exact/bouncing.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"

namespace pincer::exact {

double DroppedBall::peak(int bounces) const { return math::pow(restitution, 2 * bounces) * height; }

double DroppedBall::restTime() const {
  PINCER_ASSERT(restitution < 1);
  return std::sqrt(2 * height / g) * (1 + restitution) / (1 - restitution);
}

void SpinningBall::hit(Motion& m) const {
  const Vec3 u(m.v.x() - radius * m.w.y(), m.v.y() + radius * m.w.x(), 0);
  const double slip = u.norm(), impulse = std::min(mu * (1 + restitution) * std::abs(m.v.z()), 2.0 / 7 * slip);
  m.v.z() *= -restitution;
  if (slip == 0) return;
  m.v -= impulse * u / slip;
  m.w += 2.5 / radius * impulse * Vec3::UnitZ().cross(u / slip);
}

SpinningBall::Motion SpinningBall::after(Motion m, double time) const {
  for (;;) {
    const double fall = (m.v.z() + std::sqrt(m.v.z() * m.v.z() + 2 * g * (m.p.z() - radius))) / g;
    const double t = std::min(fall, time);
    m.p += t * m.v - Vec3(0, 0, 0.5 * g * t * t);
    m.v.z() -= g * t;
    if (time <= fall) return m;
    m.p.z() = radius;
    hit(m);
    time -= fall;
  }
}

Vec2 HeadOn::velocities(double v) const {
  const double share = std::isinf(mass2) ? 0 : mass1 / (mass1 + mass2);  // of the first in the mass
  return {v * (share - restitution * (1 - share)), v * share * (1 + restitution)};
}

}  // namespace pincer::exact
