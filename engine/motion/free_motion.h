// free_motion: rotation of a rigid body on which no torque acts.
#pragma once
#include "contact/math.h"

namespace pincer::engine {

// How the rotation of a body is advanced, chosen once from its moments of inertia.
struct FreeRotation {
  enum class Kind : unsigned char { kSpherical, kSymmetric, kTriaxial };
  Kind kind = Kind::kSpherical;
  int k = 2, i = 0, j = 1;       // principal axes: k is the symmetry axis, or the one whose removal leaves the two closest moments
  Vec3 inverse_moments = Vec3::Ones();  // [1/(kg m^2)]

  explicit FreeRotation(const Vec3& moments);
  FreeRotation() = default;
};

// Advances the orientation q_WI of the principal frame by `h` [s] with the angular momentum L_W [kg m^2/s] (about the centre of mass, in W)
// constant. Exact for spherical and symmetric bodies; 4th order in h for triaxial ones. q_WI stays a unit quaternion to round-off.
void rotateFreely(const FreeRotation& rotation, const Vec3& L_W, double h, Quat& q_WI);

// Angular velocity of the body in W [rad/s]: R I^-1 R^T L_W.
Vec3 angularVelocity(const FreeRotation& rotation, const Quat& q_WI, const Vec3& L_W);

}  // namespace pincer::engine
