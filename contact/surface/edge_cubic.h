// edge_cubic: the curve that stands for one mesh edge, from what both its triangles know of it.
//
//   smooth edge, normals N0, N1 at its ends:   V1 = P0 + c / 3 - 2 rho N0 + sigma N1,
//                                              V2 = P1 - c / 3 - rho N0 + 2 sigma N1
//     c = P1 - P0, a = N0.N1, a0 = N0.c, a1 = N1.c, rho = (2 a0 + a a1) / (3 (4 -
//     a^2)), sigma = (2 a1 + a a0) / (3 (4 - a^2))
//   crease, normals nA, nB of its two sides:   V = P + 2 d T / (3 (1 + T.g)),   T = +- (nA x nB) / |nA x nB|,  T.g >= 0
//     (the handle of a circular arc); at an end where nA = nB, T is the tangent there, g less its part along n.
//     d = |c|, g = c / d
//
//   P0, P1  ends, V1, V2  inner control points of the cubic [m]; frame B
//
// Both sides of an edge get the same curve, so there is no gap between patches. Source: D. Walton, D. Meek, "A
// triangular G1 patch from boundary curves", Computer-Aided Design 28(2), 1996, eqs. 3-6. The crease rule is ours:
// with each side's own normals gaps of 0.04 to
// 0.3 mm opened on hand-sized objects.
#pragma once
#include <array>

#include "pincer/contact/math.h"
#include "pincer/contact/surface/vec_pair.h"

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

// rho and sigma / |n1| of a smooth edge along `c` [m], for an n1 of any length.
template <class Scalar>
struct Bends {
  Scalar rho, sigma;
};
template <class Vec, class Scalar>
[[gnu::flatten]] inline auto edgeBends(const Vec& c, const Vec& n0, const Vec& n1, Scalar n1_squared) {
  const auto a = n0.dot(n1), a0 = n0.dot(c), a1 = n1.dot(c), scale = (1.0 / 3) / (4 * n1_squared - a * a);
  return Bends<decltype(scale + a)>{scale * (2 * a0 * n1_squared + a * a1), scale * (2 * a1 + a * a0)};
}

// Of a smooth edge; of two, as VecPairs. Changing the ends' roles gives the same bits.
template <class Vec>
[[gnu::flatten]] inline Handles<Vec> smoothHandles(const Vec& p0, const Vec& p1, const Vec& n0, const Vec& n1) {
  const Vec c = p1 - p0, third = (1.0 / 3) * c;
  const auto [rho, sigma] = edgeBends(c, n0, n1, 1.0);
  return {p0 + ((third - 2 * rho * n0) + sigma * n1), p1 - ((third - 2 * sigma * n1) + rho * n0)};
}

// Not where both ends' normals are opposite, or an edge has no length.
inline bool canMirror(double chord2, double sum2) {
  constexpr double kNoDirection = 1e-3;  // of a sum of unit normals
  return chord2 > 0 && sum2 > kNoDirection * kNoDirection;
}
inline bool canMirror(Two chord2, Two sum2) { return canMirror(chord2[0], sum2[0]) && canMirror(chord2[1], sum2[1]); }

// Where one of them can't: the mean as it is, or the first end's. The fold check reports such edges.
[[gnu::noinline, gnu::cold]] Vec3 middleNormalWithout(const Vec3& p0, const Vec3& p1, const Vec3& n0, const Vec3& n1);
[[gnu::noinline, gnu::cold]] VecPair middleNormalWithout(const VecPair& p0, const VecPair& p1, const VecPair& n0,
                                                         const VecPair& n1);

// The quadratic normal's middle control point on an edge from `p0` to `p1`, for two edges as VecPairs: the mean of the
// end normals, mirrored in the plane across the edge's middle, which keeps its length. Source: T. van Overveld, B.
// Wyvill, 1997; Vlachos et al., eq. 5. Changing the ends' roles gives the same bits.
template <class Vec>
[[gnu::flatten]] inline Vec middleNormal(const Vec& p0, const Vec& p1, const Vec& n0, const Vec& n1) {
  const Vec c = p1 - p0, sum = n0 + n1;
  const auto chord2 = c.squaredNorm(), sum2 = sum.squaredNorm();
  if (!canMirror(chord2, sum2)) [[unlikely]]
    return middleNormalWithout(p0, p1, n0, n1);
  const auto scale = 1 / (chord2 * squareRoots(sum2));
  return (chord2 * scale) * sum - (2 * c.dot(sum) * scale) * c;
}

}  // namespace pincer::contact
