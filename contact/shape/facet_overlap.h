// facet_overlap: where two convex solids touch, once the direction is known in which they are furthest apart.
//
// The facet of A that faces along -n and that of B that faces along n, each a polygon, a segment or a point, are
// laid over each other along n. What they share is a polygon again, whose corners are corners of A's facet,
// corners of B's, and crossings of their edges:
//
//   gap(x) = z_A(x) - z_B(x)      z  height along n of the surfaces over the point x across n [m]
//
// where z is the plane of a polygon, and over a line of a round wall (capsules, cylinders) the wall itself: all points
// lie on both surfaces. This holds face on face, edge on face, edge on edge and corner on face alike; nothing is
// remembered from tick to tick but which points were kept. Two walls side by side whose lines cross at a small angle
// touch at the crossing, and near the ends of what they share, there where one is as steep as the other; at the ends
// alone where the crossing is nearer than they are by less than 1e-7 of the size. So does a wall whose line leaves a
// polygon over an edge that is nearly parallel to it: what is beyond lies beside that edge. The end of a
// cylinder is a polygon of 16 corners, with more where the other body comes near the rim between two of them. Of more
// than four points up to four are kept (point_choice.h). A point's feature is made of the names of corners and edges
// (convex_features.h), so it stays while these touch. A corner of A counts as within B's facet up to kSamePlace of the
// size outside of it: so the corners of equal boxes on each other keep their names.
#pragma once
#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/separation.h"

namespace pincer::contact {

// The feature of a point that is a corner of a's or b's facet, by the corner's name.
constexpr std::uint32_t featureOfCorner(bool is_of_a, std::uint32_t vertex) {
  return is_of_a ? vertex << 14 : 1u << 28 | vertex;
}

// Points with gap below `margin`, sorted by feature, written to `out` as in pair_query.h, from the origin that a and b
// are posed about. `along`: what separate() found. `size` [m] is the order of magnitude of both. Allocates nothing.
// False where the facets share no place whose gap is along.gap, so that the direction isn't one of least overlap; `out`
// has the nearest points of the two along it all the same.
bool overlapFacets(const PosedSolid& a, const PosedSolid& b, const Separation& along, double size, double margin,
                   const LastPoints& last, PairPoints& out);

}  // namespace pincer::contact
