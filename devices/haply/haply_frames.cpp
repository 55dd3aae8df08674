#include "pincer/devices/haply/haply_frames.h"

#include <cmath>
#include <numbers>

namespace pincer::devices::haply {
namespace {

Quat turnAbout(const Vec3& axis, double angle) {
  const Vec3 v = math::sin(0.5 * angle) * axis;
  return {math::cos(0.5 * angle), v.x(), v.y(), v.z()};
}

}  // namespace

HaplyMap::HaplyMap(const HaplyFrame& frame) : q_align_(frame.q_align.normalized()), centre_H_(frame.centre_H) {
  const double c = math::cos(frame.mount_turn), s = math::sin(frame.mount_turn);
  Mat3 upright, turned;
  upright << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  turned << c, -s, 0, s, c, 0, 0, 0, 1;
  R_DH_ = upright * turned;
  q_DG_ = Quat(R_DH_) * turnAbout(Vec3::UnitZ(), -frame.grip_yaw);
}

// The vertical is D's y axis. Of a rotation (w, v) the part about y is (w, 0, v_y, 0), normalised.
GripDrift gripDrift(const Quat& told_DF, const Quat& q_DF) {
  const Quat off = (told_DF * q_DF.conjugate()).normalized();
  const double yaw = std::remainder(2 * math::atan2(off.y(), off.w()), 2 * std::numbers::pi);
  const Quat rest = turnAbout(Vec3::UnitY(), -yaw) * off;
  return {yaw, 2 * math::atan2(rest.vec().norm(), std::abs(rest.w()))};
}

}  // namespace pincer::devices::haply
