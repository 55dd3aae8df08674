// driven_motion: the path of a body that follows what its driver asks for: pose and velocity at the end of a tick.
//
//   p(s)     = cubic with the two places and velocities,      s = t / h, 0 .. 1
//   theta(s) = cubic from 0 to log(q_0^-1 q_1) with the two angular velocities in B;   q(s) = q_0 exp(theta(s))
//
// Both ends are exact; between them the turn errs by what the axis of rotation turns within a tick.
// Source: C. de Boor, A Practical Guide to Splines, 1978, ch. IV (cubic Hermite interpolation).
#pragma once
#include "pincer/contact/math.h"
#include "pincer/engine/motion.h"

namespace pincer::engine {

// Where the body is at share `s` of a span of `h` seconds, h > 0.
DrivenPlace drivenPlace(const DrivenPlace& start, const DrivenPlace& end, double h, double s);

// Position alone, of a driven point: the same cubic. `v` receives its velocity.
Vec3 cubicBetween(const Vec3& p_0, const Vec3& v_0, const Vec3& p_1, const Vec3& v_1, double h, double s, Vec3& v);

// The rotation vector (axis times angle, at most pi) of `q` [rad].
Vec3 rotationVectorOf(const Quat& q);

}  // namespace pincer::engine
