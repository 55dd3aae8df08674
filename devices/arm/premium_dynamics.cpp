#include "pincer/devices/arm/premium_dynamics.h"

#include <algorithm>
#include <cmath>

namespace pincer::devices::premium {
namespace {

// Table 2 of the source. Segments: a fore link, c the parallelogram's push rod, be and df the two driven capstan
// sectors with motors and counterweights. Principal moments at each segment's centre [kg m^2].
struct Segment {
  double mass, xx, yy, zz;
};
// Mass [kg], moments about x, y and z [kg m^2].
constexpr Segment kA{0.0202, 0.4864e-4, 0.001843e-4, 0.4864e-4};
constexpr Segment kC{0.0249, 0.959e-4, 0.959e-4, 0.0051e-4};
constexpr Segment kBE{0.2359, 11.09e-4, 10.06e-4, 0.591e-4};
constexpr Segment kDF{0.1906, 7.11e-4, 0.629e-4, 6.246e-4};
constexpr double kBase = 11.87e-4;  // about the vertical axis [kg m^2]
constexpr double l3 = 0.0325;       // crank of the push rod [m]

}  // namespace

Vec3 MassMatrix::solve(const Vec3& t) const {
  const double det = m22 * m33 - m23 * m23;
  return {t[0] / m11, (m33 * t[1] - m23 * t[2]) / det, (m22 * t[2] - m23 * t[1]) / det};
}

Vec3 MassMatrix::times(const Vec3& w) const { return {m11 * w[0], m22 * w[1] + m23 * w[2], m23 * w[1] + m33 * w[2]}; }

Inertia inertia(double tip_mass) {
  const double upper = l1 * l1 * (kA.mass + kC.mass / 4);
  const double fore = l2 * l2 * kA.mass / 4 + l3 * l3 * kC.mass;
  Inertia i;
  i.base = kBase;
  i.u_c = kBE.yy + kC.yy + upper + tip_mass * l1 * l1;
  i.u_s = kBE.zz + kC.zz;
  i.f_c = kA.yy + kDF.yy;
  i.f_s = kA.zz + kDF.zz + fore + tip_mass * l2 * l2;
  i.x = l1 * (l2 * kA.mass + l3 * kC.mass) + 2 * tip_mass * l1 * l2;
  i.u = kBE.xx + kC.xx + upper + tip_mass * l1 * l1;
  i.f = kA.xx + kDF.xx + fore + tip_mass * l2 * l2;
  return i;
}

MassMatrix massMatrix(const Inertia& i, const JointSines& at) {
  MassMatrix m;
  m.s2 = at.s2, m.c2 = at.c2;
  m.s3 = at.s3, m.c3 = at.c3;
  m.m11 = i.base + i.u_c * m.c2 * m.c2 + i.u_s * m.s2 * m.s2 + i.f_c * m.c3 * m.c3 + i.f_s * m.s3 * m.s3 +
          i.x * m.c2 * m.s3;
  m.m22 = i.u;
  m.m33 = i.f;
  m.m23 = -0.5 * i.x * (m.s2 * m.c3 - m.c2 * m.s3);
  return m;
}

Vec3 coriolis(const Inertia& i, const MassMatrix& m, const Vec3& w) {
  const double dm11_dq2 = 2 * (i.u_s - i.u_c) * m.s2 * m.c2 - i.x * m.s2 * m.s3;
  const double dm11_dq3 = 2 * (i.f_s - i.f_c) * m.s3 * m.c3 + i.x * m.c2 * m.c3;
  const double dm23_dq3 = 0.5 * i.x * (m.c2 * m.c3 + m.s2 * m.s3);  // and dm23/dq2 is its negative
  return {(dm11_dq2 * w[1] + dm11_dq3 * w[2]) * w[0], dm23_dq3 * w[2] * w[2] - 0.5 * dm11_dq2 * w[0] * w[0],
          -dm23_dq3 * w[1] * w[1] - 0.5 * dm11_dq3 * w[0] * w[0]};
}

Vec3 afterDryFriction(const MassMatrix& m, const Vec3& w, const Vec3& most) {
  const Vec3 stop = -m.times(w);  // the impulse that would bring every joint to rest
  if ((stop.cwiseAbs().array() <= most.array()).all()) return Vec3::Zero();
  const double det = m.m22 * m.m33 - m.m23 * m.m23;
  const double w22 = m.m33 / det, w33 = m.m22 / det, w23 = -m.m23 / det;
  Vec3 v = w;
  v[0] += std::clamp(stop[0], -most[0], most[0]) / m.m11;
  double impulse2 = 0, impulse3 = 0;
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double d2 = std::clamp(impulse2 - v[1] / w22, -most[1], most[1]) - impulse2;
    impulse2 += d2, v[1] += w22 * d2, v[2] += w23 * d2;
    const double d3 = std::clamp(impulse3 - v[2] / w33, -most[2], most[2]) - impulse3;
    impulse3 += d3, v[1] += w23 * d3, v[2] += w33 * d3;
    if (d2 == 0 && d3 == 0) break;
  }
  return v;
}

}  // namespace pincer::devices::premium
