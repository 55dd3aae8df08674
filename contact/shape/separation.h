// separation: the direction in which two convex solids are furthest apart, or overlap least.
//
//   gap(n) = min over a of n . a - max over b of n . b,   phi = max over unit n of gap(n)        n out of b towards a
//
// phi is the signed distance of the two: their distance where they are apart, the negative of the shortest way out where they overlap
// (S. Cameron, R. Culley, ICRA 1986). gap(n) is a lower bound of it in every direction, so that of several candidates the largest is right
// whoever proposed them. The maximum lies on a kink of gap in most contacts (a flat face: a point of the sphere of directions; a straight
// edge: the circle across it) or, with round rims, where gap is smooth.
//
// First Bullet's GJK on inset solids, which stay apart while the overlap is shallow (5 % of the least half width each): their direction is
// right where flat faces meet, and to some tenths of a radian near edges and rims. The kinks near it are tried and, from the best, Newton's
// method on the sphere and along the circles:
//   g = a - b, tangential part;  Hessian = -(h_A'' + h_B'') - gap 1;     h'' from bendOf (convex_features.h)
// Solids that turn out to be apart by more than 1e-5 of their size are asked again by GJK as they are, those that overlap by more than 1e-4 by
// EPA, and the search goes on from there. Between the two, where bodies rest, one of several ways out may be taken that is longer than the
// shortest, by less than the overlap.
// Error: round-off at kinks, the square of 1e-6 rad times the size where smooth.
#pragma once
#include "contact/shape/posed_solid.h"

namespace pincer::contact {

struct Separation {
  Vec3 n = Vec3::UnitZ();  // unit
  double gap = 0;          // of the two cores, without roundings [m]
};

// gap(n) for a unit `n`.
double gapAlong(const PosedSolid& a, const PosedSolid& b, const Vec3& n);

// The largest gap. `size` [m] is the order of magnitude of both. Allocates nothing, always ends; deep overlap gives a direction that leads
// out, if not the shortest.
Separation separate(const PosedSolid& a, const PosedSolid& b, double size);

// The same for two boxes by trying all 15 kinks: exact where they overlap, and where a face or a pair of edges is nearest.
// Source: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996, sec. 5.
Separation separateBoxes(const PosedSolid& a, const PosedSolid& b);

// What Bullet says: GJK on the inset solids or on the solids themselves, where they are apart; EPA where they overlap. `found` is false where
// it has no answer.
enum class Guess { kInset, kApart, kOverlap };
struct DirectionGuess {
  Vec3 n = Vec3::UnitZ();
  bool found = false;
};
DirectionGuess guessDirection(const PosedSolid& a, const PosedSolid& b, double size, Guess kind);

}  // namespace pincer::contact
