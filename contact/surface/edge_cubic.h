// edge_cubic: the curve that stands for one mesh edge, from what both its triangles know of it.
//
//   smooth edge, normals N0, N1 at its ends:   V1 = P0 + d (6 g - 2 rho N0 + sigma N1) / 18,   V2 = P1 - d (6 g + rho N0 - 2 sigma N1) / 18
//     d = |P1 - P0|, g = (P1 - P0) / d, a = N0.N1, a0 = N0.g, a1 = N1.g, rho = 6 (2 a0 + a a1) / (4 - a^2), sigma = 6 (2 a1 + a a0) / (4 - a^2)
//   crease, normals nA, nB of its two sides:   V = P + 2 d T / (3 (1 + T.g)),   T = +- (nA x nB) / |nA x nB|,  T.g >= 0
//     (the handle of a circular arc); at an end where nA = nB, T is the tangent there, g less its part along n.
//
//   P0, P1  ends, V1, V2  inner control points of the cubic [m]; frame B
//
// Both sides of an edge get the same curve, so there is no gap between patches. Source: D. Walton, D. Meek, "A triangular G1 patch from
// boundary curves", Computer-Aided Design 28(2), 1996, eqs. 3-6. The crease rule is ours: with each side's own normals gaps of 0.04 to
// 0.3 mm opened on hand-sized objects.
#pragma once
#include <array>

#include "contact/math.h"
#include "contact/surface/vec_pair.h"

namespace pincer::contact {

struct EdgeEnd {
  Vec3 p;            // [m]
  Vec3 left, right;  // unit normals of the two sides; equal on a smooth edge, and on an open border
};

template <class Vec>
struct Handles {
  Vec first, second;  // V1, V2
};
using EdgeHandles = Handles<Vec3>;

EdgeHandles edgeHandles(const EdgeEnd& from, const EdgeEnd& to);

// Of a smooth edge; of two, as VecPairs.
template <class Vec>
[[gnu::flatten]] inline Handles<Vec> smoothHandles(const Vec& p0, const Vec& p1, const Vec& n0, const Vec& n1) {
  const Vec chord = p1 - p0;
  const auto d = chord.norm();
  const Vec g = (1 / d) * chord;
  const auto a = n0.dot(n1), a0 = n0.dot(g), a1 = n1.dot(g), six = 6 / (4 - a * a);
  const auto rho = six * (2 * a0 + a * a1), sigma = six * (2 * a1 + a * a0), part = (1.0 / 18) * d;
  return {p0 + part * (6 * g - 2 * rho * n0 + sigma * n1), p1 - part * (6 * g + rho * n0 - 2 * sigma * n1)};
}

// The quadratic normal's middle control point on an edge from `p0` to `p1`: the mean of the end normals, mirrored in the plane across the
// edge's middle. Source: T. van Overveld, B. Wyvill, 1997; Vlachos et al., eq. 5. Changing the ends' roles gives the same bits.
Vec3 middleNormal(const Vec3& p0, const Vec3& p1, const Vec3& n0, const Vec3& n1);
VecPair middleNormal(const VecPair& p0, const VecPair& p1, const VecPair& n0, const VecPair& n1);

}  // namespace pincer::contact
