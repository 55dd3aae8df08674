#include "pincer/tasks/lab/participants/body.h"

#include <cmath>

namespace pincer::tasks {

Quat drawRotation(double sd, Random& random) {
  const Vec3 a = sd * random.normal3();
  const double angle = a.norm();
  if (angle == 0) return Quat::Identity();
  const auto [s, c] = math::sinCos(0.5 * angle);
  const Vec3 v = s / angle * a;
  return {c, v.x(), v.y(), v.z()};
}

Body drawBody(const HandRanges& ranges, std::uint64_t seed) {
  Random random(seed);
  Body body;
  for (auto& hand : body.hands) {
    hand.mass = random.uniform(ranges.mass_min, ranges.mass_max);
    hand.stiffness = random.uniform(ranges.stiffness_min, ranges.stiffness_max);
    hand.damping = random.uniform(ranges.damping_min, ranges.damping_max);
  }
  body.speed = random.uniform(ranges.speed_min, ranges.speed_max);
  return body;
}

BodySense drawBodySense(const SensingLimits& limits, Random& random) {
  const Vec3 shared = limits.placement_sd * random.normal3();
  const Vec3 between = limits.placement_between_sd * random.normal3();
  BodySense sense;
  sense.misplacement_W = {Vec3(shared - 0.5 * between), Vec3(shared + 0.5 * between)};
  for (auto& q : sense.q_felt_true) q = drawRotation(limits.orientation_sd, random);
  return sense;
}

}  // namespace pincer::tasks
