#include "pincer/engine/motion/driven_motion.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {

Vec3 cubicBetween(const Vec3& p_0, const Vec3& v_0, const Vec3& p_1, const Vec3& v_1, double h, double s, Vec3& v) {
  PINCER_ASSERT(h > 0);
  const Vec3 slope = (p_1 - p_0) / h;
  const Vec3 c2 = 3 * slope - 2 * v_0 - v_1;
  const Vec3 c3 = v_0 + v_1 - 2 * slope;
  v = v_0 + s * (2 * c2 + 3 * s * c3);
  return p_0 + h * s * (v_0 + s * (c2 + s * c3));
}

DrivenPlace drivenPlace(const DrivenPlace& start, const DrivenPlace& end, double h, double s) {
  PINCER_ASSERT(s >= 0);
  PINCER_ASSERT(isUnitIfFinite(start.X_WB.q) && isUnitIfFinite(end.X_WB.q));
  if (s >= 1) return end;
  DrivenPlace now;
  now.X_WB.p = cubicBetween(start.X_WB.p, start.motion.v_W, end.X_WB.p, end.motion.v_W, h, s, now.motion.v_W);
  const Vec3 turn_B = rotationVectorOf(start.X_WB.q.conjugate() * end.X_WB.q);
  const Vec3 w0_B = start.X_WB.q.conjugate() * start.motion.w_W, w1_B = end.X_WB.q.conjugate() * end.motion.w_W;
  Vec3 w_B;
  now.X_WB.q = start.X_WB.q * quatFromRotationVector(cubicBetween(Vec3::Zero(), w0_B, turn_B, w1_B, h, s, w_B));
  now.X_WB.q.normalize();
  now.motion.w_W = now.X_WB.q * w_B;
  return now;
}

Vec3 rotationVectorOf(const Quat& q) {
  PINCER_ASSERT(isUnitIfFinite(q));
  const double sign = q.w() < 0 ? -1 : 1;
  const double sine = q.vec().norm();
  if (sine == 0) return Vec3::Zero();
  return (sign * 2 * math::atan2(sine, std::abs(q.w())) / sine) * q.vec();
}

}  // namespace pincer::engine
