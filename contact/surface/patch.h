// patch: the smooth surface over one triangle, a cubic for the place and a quadratic for the normal, in Bernstein form.
//
//   S(u,v) = sum 3!/(i! j! k!) b_ijk w^i u^j v^k,   N(u,v) = sum 2!/(i! j! k!) n_ijk w^i u^j v^k,   w = 1 - u - v
//
//   u, v, w  barycentric coordinates of corners 1, 2, 0 [-];  b_ijk [m], n_ijk [-] in frame B
//
// N isn't of unit length between the corners; everything that follows is indifferent to its length.
// Source: A. Vlachos et al., "Curved PN triangles", 2001, eqs. 1 and 3; A. J. Doxon, doctoral text, 2014, eq. 6 for the factor 2 on the mixed
// normals, which the former lacks: without it contact runs at 0.57 to 1.25 of the true speed however fine the mesh.
#pragma once
#include <array>

#include "contact/math.h"

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

// Component by component: as vector expressions it took four times the instructions.
inline PatchPoint evaluate(const Patch& p, double u, double v) {
  const double w = 1 - u - v;
  const double ww = w * w, uu = u * u, vv = v * v, wu = 2 * w * u, wv = 2 * w * v, uv = 2 * u * v;
  PatchPoint x;
  for (int k = 0; k < 3; ++k) {
    const double Sw = p.b300[k] * ww + p.b120[k] * uu + p.b102[k] * vv + p.b210[k] * wu + p.b201[k] * wv + p.b111[k] * uv;
    const double Su = p.b210[k] * ww + p.b030[k] * uu + p.b012[k] * vv + p.b120[k] * wu + p.b111[k] * wv + p.b021[k] * uv;
    const double Sv = p.b201[k] * ww + p.b021[k] * uu + p.b003[k] * vv + p.b111[k] * wu + p.b102[k] * wv + p.b012[k] * uv;
    const double Nw = p.n200[k] * w + p.n110[k] * u + p.n101[k] * v;
    const double Nu = p.n110[k] * w + p.n020[k] * u + p.n011[k] * v;
    const double Nv = p.n101[k] * w + p.n011[k] * u + p.n002[k] * v;
    x.S[k] = Sw * w + Su * u + Sv * v;
    x.N[k] = Nw * w + Nu * u + Nv * v;
    x.Su[k] = 3 * (Su - Sw);
    x.Sv[k] = 3 * (Sv - Sw);
    x.Nu[k] = 2 * (Nu - Nw);
    x.Nv[k] = 2 * (Nv - Nw);
  }
  return x;
}

// The place alone, at a third of the cost.
inline Vec3 place(const Patch& p, double u, double v) {
  const double w = 1 - u - v;
  const double ww = w * w, uu = u * u, vv = v * v;
  return p.b300 * (ww * w) + p.b030 * (uu * u) + p.b003 * (vv * v) +
         3 * (p.b210 * (ww * u) + p.b120 * (w * uu) + p.b201 * (ww * v) + p.b021 * (uu * v) + p.b102 * (w * vv) + p.b012 * (u * vv)) +
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
