#include "devices/arm/premium_kinematics.h"

#include <cmath>
#include <numbers>

namespace pincer::devices::premium {
namespace {

double reach(const Vec3& q) { return l1 * std::cos(q[1]) + l2 * std::sin(q[2]); }

}  // namespace

Vec3 forward(const Vec3& q) {
  const double r = reach(q);
  return {r * std::sin(q[0]), l2 - l2 * std::cos(q[2]) + l1 * std::sin(q[1]), r * std::cos(q[0]) - l1};
}

std::optional<Vec3> inverse(const Vec3& p_DF) {
  const double R = std::hypot(p_DF.x(), p_DF.z() + l1);
  const double h = p_DF.y() - l2;
  const double D = std::hypot(R, h);  // from the shoulder to the fingertip
  const double at_shoulder = (l1 * l1 + D * D - l2 * l2) / (2 * l1 * D);
  const double at_elbow = (l1 * l1 + l2 * l2 - D * D) / (2 * l1 * l2);
  if (!(std::abs(at_shoulder) <= 1 && std::abs(at_elbow) <= 1)) return std::nullopt;  // D = 0 makes at_shoulder infinite
  const double q2 = std::atan2(h, R) + std::acos(at_shoulder);
  return Vec3(std::atan2(p_DF.x(), p_DF.z() + l1), q2, q2 + std::acos(at_elbow) - std::numbers::pi / 2);
}

Mat3 jacobian(const Vec3& q) {
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
  const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double s3 = std::sin(q[2]), c3 = std::cos(q[2]);
  const double r = l1 * c2 + l2 * s3;
  Mat3 J;
  J << c1 * r, -l1 * s1 * s2, l2 * s1 * c3,  //
      0, l1 * c2, l2 * s3,                   //
      -s1 * r, -l1 * c1 * s2, l2 * c1 * c3;
  return J;
}

double dexterity(const Vec3& q) { return reach(q) / l1 * std::cos(q[1] - q[2]); }

bool withinLimits(const JointLimits& limits, const Vec3& q) {
  return (q.array() >= limits.min.array()).all() && (q.array() <= limits.max.array()).all() && std::abs(q[1] - q[2]) <= limits.elbow;
}

}  // namespace pincer::devices::premium
