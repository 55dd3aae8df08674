// separation: the direction in which two convex solids are furthest apart, or overlap least.
//
//   gap(n) = min over a of n . a - max over b of n . b,   phi = max over unit n of gap(n)        n out of b towards a
//
// phi is the signed distance of the two: their distance where they are apart, the negative of the shortest way out
// where they overlap (S. Cameron, R. Culley, ICRA 1986). gap(n) is a lower bound of it in every direction, so that of
// several candidates the largest is right whoever proposed them.
//
// From a direction n0 one step leads to a better one: a is moved along n0 until the two
// are apart by a hundredth of their size, and
//
//   n1 = direction of the nearest points of the two (core_distance.h)
//   gap(n1) >= gap(n0), equal only where no small turn improves it
//
// (the nearest points of the moved solids are apart by d >= the hundredth = gap(n0) + t, so gap(n1) = d - t n0 . n1 >=
// gap(n0); it is the convex-concave procedure of A. Yuille, A. Rangarajan, Neural Computation 15, 2003). Where flat
// faces or straight edges meet one step is exact; solids that are apart aren't moved, and one step finds the greatest
// distance of all. The touching and overlapping, for which others need cores and margins, are thereby no special case.
// At round rims gap is smooth, and Newton's method ends the search, on the sphere
// and on the circles across straight edges:
//   g = a - b, tangential part;  Hessian = -(h_A'' + h_B'') - gap 1;     h'' from bendOf (convex_features.h)
// Where the gap is concave along one direction only, the step goes uphill along the other: of a corner that all but
// meets a rim the way to the kink with the greatest gap is as narrow as the rim bends, and up to a quarter turn long.
//
// The search begins from the nearest points, or from the direction of the last tick. Of solids that overlap the step
// also leaves three points of A - B in a plane n1 . x = gap: with r how far the foot of the origin is within that
// triangle, every direction within 90 degrees of n1 that is better must be turned by more than 2 atan(r / -gap). So r >
// 4 |gap|, and depth enough on the far side, prove that n1 is the best there is; that is so wherever facets or crossing
// edges overlap by more than the solids are deep in each other. On faces four points of A - B, furthest along as many
// directions in the plane across the normal, show the same without a step: with the last direction near a face's normal
// nothing else is asked. Where it isn't proved (beside edges and corners, deep in each other), the best of several
// local maxima is taken: those above the axes of both and the line of their origins, the cross products of axes, the
// nearest points of the solids inset by 5 % of the least half width, and Bullet's EPA. Error: round-off; at round rims
// 1e-9 of the size. Of very deep overlap it may be one of several ways out that isn't the shortest.
#pragma once
#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

struct Separation {
  Vec3 n = Vec3::UnitZ();  // unit
  double gap = 0;          // of the two cores, without roundings [m]
};

// gap(n) for a unit `n`.
double gapAlong(const PosedSolid& a, const PosedSolid& b, const Vec3& n);

// The largest gap, or, where it is more than `reach` [m], any that is. `size` [m] is the order of magnitude of both.
// `last`: where to begin, unit, or zero: then from the line of the origins. Allocates nothing, always ends.
Separation separate(const PosedSolid& a, const PosedSolid& b, double size, double reach = kInfinity,
                    const Vec3& last = Vec3::Zero());

// The same for two boxes by trying all 15 kinks: exact where they overlap, and where a face or a pair of edges is
// nearest. Source: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996, sec. 5.
Separation separateBoxes(const PosedSolid& a, const PosedSolid& b);

// Answer of Bullet's EPA for solids that overlap. `found` is false where it has no answer.
struct DirectionGuess {
  Vec3 n = Vec3::UnitZ();
  bool found = false;
};
DirectionGuess guessWayOut(const PosedSolid& a, const PosedSolid& b, double size);

}  // namespace pincer::contact
