// mesh_pairs: contact points of a mesh, also a concave one, with a convex solid. pair_query.h lets boxes and capsules through: a hull's
// contacts were missed in places, and a cylinder's nearest points are not exact where its rim meets an edge.
//
// Triangles near the other body are found through the mesh's tree; then the closest features decide, each with the direction that its
// geometry gives:
//   corner of the mesh on the solid     the solid's nearest point and normal there (closed_forms.h)
//   corner of the solid on a triangle   the triangle's plane, where the corner lies over the triangle; which corners: those of the solid's
//                                       facet that faces the triangle (convex_features.h)
//   edge on edge                        across both edges, where that direction lies between the normals on either side of both; against a
//                                       solid the edge is a segment, and separation.h gives the direction
// All are local, so that the depth of shallow overlap is right also in hollows; a feature that is deeper than kDeepest of the smaller body
// is taken for one of the far side and left out. Contact is with the flat triangles, not with the smooth surface between their corners: they
// differ by up to e^2 k / 8 (edge length e, curvature k), as on half-spaces (pair_query.h).
//
// Of all candidates up to four are kept: those of like normal (within kLike) form a group; the deepest of each group first, then within
// groups in turn the one that is furthest from what the group has, by point_choice.h's d^2 / (g + s).
// Cost: about 0.1 us per triangle near the other body, plus a few us per edge that lies across an edge of it; at most kMostTriangles
// are looked at.
#pragma once
#include "contact/shape/pair_query.h"

namespace pincer::contact {

constexpr int kMostTriangles = 20000;

// As collideShapes (pair_query.h); n out of the solid (b) towards the mesh (a), both poses in W. Allocates nothing.
void collideMeshWithConvex(const Mesh& mesh, const Pose& X_WA, const Shape& solid, const Pose& X_WB, double margin, PairPoints& out);

}  // namespace pincer::contact
