// math: the vectors, rotations and poses of every page (notation: docs/notation.md).
//
//   X_WB  pose of frame B in frame W:  p_WC = X_WB * p_BC,  v_W = X_WB.q * v_B
//
// SI units and radians throughout.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "pincer/contact/elementary.h"

namespace pincer {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

// A rigid displacement: rotate by the unit quaternion `q`, then translate by `p` [m].
struct Pose {
  Quat q = Quat::Identity();
  Vec3 p = Vec3::Zero();

  Vec3 operator*(const Vec3& p_BC) const { return q * p_BC + p; }
  Pose operator*(const Pose& X_BC) const { return {q * X_BC.q, q * X_BC.p + p}; }
  Pose inverse() const { return {q.conjugate(), -(q.conjugate() * p)}; }
};

// Angle between two vectors of any length [rad], accurate near 0 and pi.
inline double angleBetween(const Vec3& a, const Vec3& b) { return math::atan2(a.cross(b).norm(), a.dot(b)); }

// Angle of the rotation that turns `a` into `b` [rad], 0 .. pi, accurate near 0 and pi.
inline double angleBetween(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * math::atan2(d.vec().norm(), std::abs(d.w()));  // atan2 also resolves angles that acos(w) rounds to zero
}

// Twice the area that two vectors of the plane span, positive when b lies to the left of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// 1 or -1; not copysign: -0.0 must choose like 0.0.
inline double signOf(double a) { return a < 0 ? -1 : 1; }

constexpr double kDegree = M_PI / 180;                                 // [rad]
constexpr double kInfinity = std::numeric_limits<double>::infinity();  // a bound in any unit that bounds nothing

// Right-handed orthonormal frame whose third column is the unit vector `n`; columns (t1, t2, n).
// Continuous in n but for n = -z. Source: T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
inline Mat3 frameFromNormal(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  Mat3 R;
  R.col(0) << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x();
  R.col(1) << b, sign + n.y() * n.y() * a, -n.y();
  R.col(2) = n;
  return R;
}

// Quaternion of the rotation vector `a` [rad] (axis times angle), accurate to round-off for any angle.
inline Quat quatFromRotationVector(const Vec3& a) {
  const double angle2 = a.squaredNorm();
  if (angle2 < 1e-8) {  // the series' next term is below 1e-20 here
    const double s = 0.5 - angle2 / 48;
    return {1 - angle2 / 8, s * a.x(), s * a.y(), s * a.z()};
  }
  const double angle = std::sqrt(angle2);
  const auto half = math::sinCos(0.5 * angle);
  const double s = half.sin / angle;
  return {half.cos, s * a.x(), s * a.y(), s * a.z()};
}

}  // namespace pincer
