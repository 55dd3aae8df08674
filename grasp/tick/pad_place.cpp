#include "pincer/grasp/pad_place.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/grasp/step.h"

namespace pincer::grasp {

Vec2 placeOnPad(const FingerModel& finger, const PadTouch& touch) {
  if (!touch.there) return Vec2::Zero();
  PINCER_ASSERT(isUnitIfFinite(touch.q_WF));
  const Quat q_FW = touch.q_WF.conjugate();
  return finger.shape ? placeOnPad(finger, q_FW * touch.d_W, q_FW * touch.n_W) : placeOnPad(finger, q_FW * touch.d_W);
}

Vec2 placeOnPad(const FingerModel& finger, const Vec3& d_F) {
  PINCER_ASSERT(std::abs(finger.pad_normal_F.dot(finger.distal_F)) < 1e-6);  // as buildGrasp has checked
  const Vec3 radial_F = finger.pad_normal_F.cross(finger.distal_F);
  const Vec2 tangent(d_F.dot(finger.distal_F), d_F.dot(radial_F));
  const double sine = tangent.norm();
  if (sine < 1e-300) return Vec2::Zero();
  if (finger.shape) return placeOnPad(finger, contact::supportOf(*finger.shape, d_F.normalized()), d_F.normalized());
  return (finger.radius * math::atan2(sine, d_F.dot(finger.pad_normal_F)) / sine) * tangent;
}

Vec2 placeOnPad(const FingerModel& finger, const Vec3& p_F, const Vec3& normal_F) {
  if (!finger.shape) return placeOnPad(finger, normal_F);
  const Vec3 from_centre = p_F - contact::supportOf(*finger.shape, finger.pad_normal_F);
  const Vec2 tangent(from_centre.dot(finger.distal_F), from_centre.dot(finger.pad_normal_F.cross(finger.distal_F)));
  const double length = tangent.norm();
  if (length < 1e-300) return Vec2::Zero();
  return contact::arcOverSkin(*finger.shape, finger.pad_normal_F, normal_F, p_F) / length * tangent;
}

Vec2 placeRateOnPad(const FingerModel& finger, const FingerReport& report, double h) {
  PINCER_DEMAND(h > 0, "placeRateOnPad: the tick's length is positive");
  if (!report.touch.there || !report.last_touch.there) return Vec2::Zero();
  return (placeOnPad(finger, report.touch) - placeOnPad(finger, report.last_touch)) / h;
}

}  // namespace pincer::grasp
