// edge_on_solid: where a straight edge of a mesh is nearest to a convex solid, or deepest in it.
//
//   gap(n) = n . p - max over b of n . b,   n across the edge, between n_lo and n_hi         p any point of the edge
//
// n_lo and n_hi are the directions out of the solid that are across the edge's two faces. Seen along the edge
// this is a point and a convex figure; where the gap is greatest between the two, the edge may touch; where at
// n_lo or n_hi, one of its faces. Of a point within the figure each edge of the figure is a maximum: all are
// found whose gap is no less than `deepest`. The chord between the furthest points along two directions has a
// normal between them, and where no point lies beyond it, it is an edge of the figure, and n exact; for round
// figures steps of the method of false position follow.
#pragma once
#include <array>

#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

struct EdgeContact {
  Vec3 n;      // unit, out of the solid
  Vec3 p;      // of the solid's core [m]
  double gap;  // of the solid's core and the edge [m]
};
struct EdgeContacts {
  static constexpr int kMost = 8;  // chosen: a box seen along an edge has up to 6 sides; further ones are left out
  std::array<EdgeContact, kMost> all;
  int count = 0;
};

// `e`: unit direction of the edge; `deepest` < 0 [m]. Allocates nothing.
EdgeContacts edgeOnSolid(const Vec3& p, const Vec3& e, const Vec3& n_lo, const Vec3& n_hi, const PosedSolid& solid,
                         double deepest);

}  // namespace pincer::contact
