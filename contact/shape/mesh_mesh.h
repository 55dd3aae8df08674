// mesh_mesh: contact points of two meshes, also concave ones, felt as their flat triangles.
//
//   corner of one on the other   the faces that it lies over, or the nearest point where it lies over none
//   edge of one on one of the other, both convex   across both, n = e_a x e_b / |e_a x e_b|
//
// A direction counts only where both surfaces around the two features lie on their own sides of the plane across it:
// what is a corner here is one of mesh_pairs.h, with the same rules for depth, for what is behind the surface and for
// which points are kept. (Smooth shading isn't felt between meshes: two round bodies roll on each other's facets.)
// Corners and edges are looked for where the boxes of one tree meet those of the other, in trees of those triangles
// alone that have some: a flat face costs as much as its outline, however finely it is cut.
// Cost: some us per corner or edge that is near the other's surface, however many.
#pragma once
#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// As collideShapes (pair_query.h); n out of b towards a, both poses in W. Allocates nothing.
void collideMeshes(const Mesh& a, const Pose& X_WA, const Mesh& b, const Pose& X_WB, double margin,
                   const LastPoints& last, PairPoints& out);

}  // namespace pincer::contact
