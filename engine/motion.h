// motion: velocities and places of what moves, and how a body's free rotation is advanced.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::engine {

// Velocity of a body's centre of mass or of a point, and angular velocity; a point's is zero.
struct Motion {
  Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();
};

// Pose of a body's frame B, velocity of B's origin, angular velocity.
struct DrivenPlace {
  Pose X_WB;
  Motion motion;
};

// How the rotation of a body is advanced, chosen once from its moments of inertia (engine/motion/free_motion.h).
struct FreeRotation {
  enum class Kind : unsigned char { kSpherical, kSymmetric, kTriaxial };
  Kind kind = Kind::kSpherical;
  // principal axes, right-handed: k is the symmetry axis, or the one whose removal leaves the two closest moments
  int k = 2, i = 0, j = 1;
  Vec3 inverse_moments = Vec3::Ones();       // [1/(kg m^2)]
  Vec3 root_inverse_moments = Vec3::Ones();  // their roots

  // Moments that agree to 1e-13 count as equal.  moments  each > 0 [kg m^2]
  explicit FreeRotation(const Vec3& moments);
  FreeRotation() = default;
};

}  // namespace pincer::engine
