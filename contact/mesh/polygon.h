// polygon: triangles of a simple polygon in space, nearly flat.
//
//   n = sum over edges of p_i x p_{i+1}   (Newell's normal, twice the polygon's area; M. E. Newell in
//                                         Sutherland et al., Computing Surveys 6(1), 1974)
//
// A strictly convex polygon becomes a fan; any other loses one ear after the other (G. H. Meisters, Amer. Math. Monthly
// 82(6), 1975) in the plane across n. No triangle has zero area, also where corners lie on a straight line.
#pragma once
#include <array>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

using CornerTriple = std::array<int, 3>;

// True if the triangle's height over its longest edge is below round-off of its corners: it has no direction then.
bool hasZeroArea(const Vec3& p0, const Vec3& p1, const Vec3& p2);

// Corners of `polygon` (at least 3), three per triangle, in the polygon's orientation. Empty if there is no such set:
// the polygon has no area or crosses itself. Takes at most some n^2 steps.
std::vector<CornerTriple> triangulate(const std::vector<Vec3>& polygon);

}  // namespace pincer::contact
