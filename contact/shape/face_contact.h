// face_contact: two convex solids that stand apart, one of them over a face of the
// other, as a pad on a box or a rod on a pad.
//
//   p in the face F of the one, q in the other, its lowest point along n, the face's normal, with  q - p = g n,  g > 0
//   =>  p and q are nearest to each other, and n is the direction in which the two are furthest apart (separation.h)
//
// (n is in the normal cones of both.) Of many lowest points, as flush faces and lines have, one within round-off
// of the lowest that lies over F will do; or all of them are, and the facets share a place. No other direction
// need be tried: this costs a fifth of separate() and overlapFacets(), says the same to round-off, with the same
// features, and of round walls more exactly.
// A fingertip's core and a body are apart by the tip's rounding while they touch.
#pragma once
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

// True if a face along the normal of `last` (unit, out of b towards a) shows that; then `out` is as overlapFacets
// writes it. `margin`, `size`, the frame: as there.
bool touchOnFaces(const PosedSolid& a, const PosedSolid& b, const LastPoints& last, double size, double margin,
                  PairPoints& out);

}  // namespace pincer::contact
