#include "pincer/devices/arm/premium_kinematics.h"

#include <cmath>
#include <numbers>

namespace pincer::devices::premium {
namespace {

double reach(const Vec3& q) { return l1 * math::cos(q[1]) + l2 * math::sin(q[2]); }

}  // namespace

JointSines::JointSines(const Vec3& q) {
  const auto base = math::sinCos(q[0]), upper = math::sinCos(q[1]), fore = math::sinCos(q[2]);
  s1 = base.sin, c1 = base.cos;
  s2 = upper.sin, c2 = upper.cos;
  s3 = fore.sin, c3 = fore.cos;
}

Vec3 forward(const JointSines& at) {
  const auto& [s1, c1, s2, c2, s3, c3] = at;
  const double r = l1 * c2 + l2 * s3;
  return {r * s1, l2 - l2 * c3 + l1 * s2, r * c1 - l1};
}

std::optional<Vec3> inverse(const Vec3& p_DF) {
  const double R = math::hypot(p_DF.x(), p_DF.z() + l1);
  const double h = p_DF.y() - l2;
  const double D = math::hypot(R, h);  // from the shoulder to the fingertip
  const double at_shoulder = (l1 * l1 + D * D - l2 * l2) / (2 * l1 * D);
  const double at_elbow = (l1 * l1 + l2 * l2 - D * D) / (2 * l1 * l2);
  // D = 0 makes at_shoulder infinite
  if (!(std::abs(at_shoulder) <= 1 && std::abs(at_elbow) <= 1)) return std::nullopt;
  const double q2 = math::atan2(h, R) + math::acos(at_shoulder);
  return Vec3(math::atan2(p_DF.x(), p_DF.z() + l1), q2, q2 + math::acos(at_elbow) - std::numbers::pi / 2);
}

Mat3 jacobian(const JointSines& at) {
  const auto& [s1, c1, s2, c2, s3, c3] = at;
  const double r = l1 * c2 + l2 * s3;
  Mat3 J;
  J << c1 * r, -l1 * s1 * s2, l2 * s1 * c3,  //
      0, l1 * c2, l2 * s3,                   //
      -s1 * r, -l1 * c1 * s2, l2 * c1 * c3;
  return J;
}

double dexterity(const Vec3& q) { return reach(q) / l1 * math::cos(q[1] - q[2]); }

bool withinLimits(const JointLimits& limits, const Vec3& q) {
  return (q.array() >= limits.min.array()).all() && (q.array() <= limits.max.array()).all() &&
         std::abs(q[1] - q[2]) <= limits.elbow;
}

}  // namespace pincer::devices::premium
