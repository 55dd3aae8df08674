// random_poses: directions and rotations drawn evenly, and rotations about an axis.
#pragma once
#include "pincer/contact/math.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::tests {

// Evenly over the unit sphere (by rejection from the cube).
inline Vec3 direction(RandomNumbers& random) {
  Vec3 d;
  // braces: drawn from left to right by every compiler
  do d = Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  while (d.norm() > 1 || d.norm() < 0.1);
  return d.normalized();
}

// Evenly over all rotations (by rejection from the 4-cube).
inline Quat rotation(RandomNumbers& random) {
  Quat q;
  do q.coeffs() << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1);
  while (q.norm() > 1 || q.norm() < 0.1);
  return q.normalized();
}

inline Quat about(const Vec3& axis, double angle) { return Quat(Eigen::AngleAxisd(angle, axis.normalized())); }

}  // namespace pincer::tests
