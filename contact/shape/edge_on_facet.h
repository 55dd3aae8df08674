// edge_on_facet: the part of a mesh's straight edge that a convex solid's facet shares
// with it, seen along a normal of contact.
//
//   x(t) = p + t e,   gap(t) = how far x(t) is from the solid along n
//   p  begin of the edge [m], e  its direction, t [m]
//
// Over a polygon the gap is linear in t, so that it is least, and bodies that lie on each other are carried, at the two
// ends of that part: ends of the edge, and places where the edge crosses the polygon's outline. (Source of the
// clipping: M. Cyrus, J. Beck, Computers & Graphics 3(1), 1978.) The end of a cylinder is the disc that it is, not the
// polygon that stands for it elsewhere. Over a line of a round wall the gap is that of the wall; an edge that crosses
// the line at more than a small angle has no part of it but the crossing.
#pragma once
#include <array>

#include "pincer/contact/shape/posed_solid.h"

namespace pincer::contact {

struct EdgePart {
  struct End {
    double t;    // [m]
    double phi;  // [m]
  };
  std::array<End, 2> ends{};  // first where the edge comes over the facet
  bool is_over_face = false;  // of a polygon; otherwise the edge may be nearer to the solid between the ends
  bool found = false;
};

// `e`, `n` unit, n out of the solid and across e; `slack` [m] beside the facet counts as over it. Allocates nothing.
EdgePart partOverFacet(const Vec3& p, const Vec3& e, double length, const Vec3& n, const PosedSolid& solid,
                       double slack);

}  // namespace pincer::contact
