// patch: the smooth surface over one triangle, a cubic for the place and a quadratic for the normal, in Bernstein form.
//
//   S(u,v) = sum 3!/(i! j! k!) b_ijk w^i u^j v^k,   N(u,v) = sum 2!/(i! j! k!) n_ijk w^i u^j v^k,   w = 1 - u - v
//
//   u, v, w  barycentric coordinates of corners 1, 2, 0 [-];  b_ijk [m], n_ijk [-] in frame B
//
// N isn't of unit length between the corners; everything that follows is indifferent to its length.
// Source: A. Vlachos et al., "Curved PN triangles", 2001, eqs. 1 and 3; A. J. Doxon, doctoral text, 2014,
// eq. 6 for the factor 2 on the mixed normals, which the former lacks: without it contact runs at 0.57 to
// 1.25 of the true speed however fine the mesh.
#pragma once
#include <array>

#include "pincer/contact/math.h"

namespace pincer::contact {

struct Patch {
  Vec3 b300, b030, b003;  // corners 0, 1, 2
  Vec3 b210, b120;        // edge 0, from corner 0 to 1
  Vec3 b021, b012;        // edge 1, from corner 1 to 2
  Vec3 b102, b201;        // edge 2, from corner 2 to 0
  Vec3 b111;              // centre
  Vec3 n200, n020, n002;  // corners, unit
  Vec3 n110, n011, n101;  // middle of edges 0, 1, 2
};

struct PatchPoint {
  Vec3 S, N;    // place [m] and normal [-]
  Vec3 Su, Sv;  // dS/du, dS/dv [m]
  Vec3 Nu, Nv;  // dN/du, dN/dv [-]
};

// x and y side by side in one register, and z: the bits are those of one component at a
// time, at two thirds of the instructions.
struct AxesXY {
  using Value = Eigen::Array2d;
  static Value of(const Vec3& v) { return v.head<2>(); }
  static void set(Vec3& v, const Value& value) { v.head<2>() = value; }
};
struct AxisZ {
  using Value = double;
  static Value of(const Vec3& v) { return v.z(); }
  static void set(Vec3& v, Value value) { v.z() = value; }
};

// Flattened, for compilers that take many sources at once stop inlining such small parts, at three times the cost.
template <class Axes>
[[gnu::flatten]] inline void evaluateAlong(const Patch& p, double u, double v, PatchPoint& x) {
  using Value = typename Axes::Value;
  const double w = 1 - u - v;
  const double ww = w * w, uu = u * u, vv = v * v, wu = 2 * w * u, wv = 2 * w * v, uv = 2 * u * v;
  const auto of = [](const Vec3& a) -> Value { return Axes::of(a); };
  const Value b210 = of(p.b210), b120 = of(p.b120), b201 = of(p.b201), b102 = of(p.b102), b021 = of(p.b021),
              b012 = of(p.b012), b111 = of(p.b111);
  const Value Sw = of(p.b300) * ww + b120 * uu + b102 * vv + b210 * wu + b201 * wv + b111 * uv;
  const Value Su = b210 * ww + of(p.b030) * uu + b012 * vv + b120 * wu + b111 * wv + b021 * uv;
  const Value Sv = b201 * ww + b021 * uu + of(p.b003) * vv + b111 * wu + b102 * wv + b012 * uv;
  const Value n110 = of(p.n110), n011 = of(p.n011), n101 = of(p.n101);
  const Value Nw = of(p.n200) * w + n110 * u + n101 * v;
  const Value Nu = n110 * w + of(p.n020) * u + n011 * v;
  const Value Nv = n101 * w + n011 * u + of(p.n002) * v;
  Axes::set(x.S, Sw * w + Su * u + Sv * v);
  Axes::set(x.N, Nw * w + Nu * u + Nv * v);
  Axes::set(x.Su, 3 * (Su - Sw));
  Axes::set(x.Sv, 3 * (Sv - Sw));
  Axes::set(x.Nu, 2 * (Nu - Nw));
  Axes::set(x.Nv, 2 * (Nv - Nw));
}

inline PatchPoint evaluate(const Patch& p, double u, double v) {
  PatchPoint x;
  evaluateAlong<AxesXY>(p, u, v, x);
  evaluateAlong<AxisZ>(p, u, v, x);
  return x;
}

// The place alone, at a third of the cost.
inline Vec3 place(const Patch& p, double u, double v) {
  const double w = 1 - u - v;
  const double ww = w * w, uu = u * u, vv = v * v;
  return p.b300 * (ww * w) + p.b030 * (uu * u) + p.b003 * (vv * v) +
         3 * (p.b210 * (ww * u) + p.b120 * (w * uu) + p.b201 * (ww * v) + p.b021 * (uu * v) + p.b102 * (w * vv) +
              p.b012 * (u * vv)) +
         p.b111 * (6 * w * u * v);
}

// Control points of edge i, from its corner i on.
inline std::array<Vec3, 4> edgeCurve(const Patch& p, int i) {
  if (i == 0) return {p.b300, p.b210, p.b120, p.b030};
  if (i == 1) return {p.b030, p.b021, p.b012, p.b003};
  return {p.b003, p.b102, p.b201, p.b300};
}
inline std::array<Vec3, 3> edgeNormals(const Patch& p, int i) {
  if (i == 0) return {p.n200, p.n110, p.n020};
  if (i == 1) return {p.n020, p.n011, p.n002};
  return {p.n002, p.n101, p.n200};
}
inline std::array<Vec3, 10> controlPoints(const Patch& p) {
  return {p.b300, p.b030, p.b003, p.b210, p.b120, p.b021, p.b012, p.b102, p.b201, p.b111};
}

}  // namespace pincer::contact
