// mesh_pairs: contact points of a mesh, also a concave one, with a convex solid.
//
// Triangles near the other body are found through the mesh's tree; then the closest features decide, each
// with the direction that its geometry gives:
//   corner of the mesh on the solid     the solid's nearest point and normal there, or the wall that it is behind
//                                       (solid_walls.h)
//   corner of the solid on a triangle   the triangle's plane, where the corner lies over the triangle; which corners:
//                                       those of the solid's facet that faces the triangle (convex_features.h)
//   edge of the mesh on the solid       the direction between those of the edge's two faces in which the gap is
//                                       greatest (edge_on_solid.h); of a facet of the solid that faces the edge there,
//                                       both ends of what they share (edge_on_facet.h)
// A direction counts only where the mesh around the corner or edge lies on the far side of the plane across it. All are
// local, so that the depth of shallow overlap is right also in hollows. What is behind the surface must be in the body,
// and no other way out much shorter (MeshScale::isWayOut): the far side of a thin plate doesn't count. Where that
// leaves nothing, as of a rim across an edge of the mesh with the end of the cylinder close by, the shallowest of the
// refused is the contact: bodies that overlap are never without one. All this is of the flat triangles, within the
// margin and as much more as the smooth surface is from them at most. From there the points are led to the smooth
// surface (smooth_lead.h); a mesh whose surface is its triangles is done. A pad's points stay those of the triangles:
// they tell where these are the surface (finger_query.h).
//
// Of all candidates up to eight are kept: those of like normal (within kLikeNormals) form a group; the deepest of each
// group first, then within groups in turn the one that is furthest from what the group has, by point_choice.h's d^2 /
// (g + s). Cost: about 0.1 us per triangle near the other body, however many.
#pragma once
#include "pincer/contact/pair_query.h"

namespace pincer::contact {

// As collideShapes (pair_query.h); n out of the solid (b) towards the mesh (a), both poses in W. Allocates nothing.
void collideMeshWithConvex(const Mesh& mesh, const Pose& X_WA, const Shape& solid, const Pose& X_WB, double margin,
                           const LastPoints& last, PatchCache& cache, PairPoints& out);

// Of a fingertip that is the convex `core` at X_BF with a ball of radius `rounding` >= 0 [m] about it,
// with the mesh's flat triangles: points in the mesh's frame B, normals out of the mesh. Allocates
// nothing once the mesh's features are built.
void collidePadWithMesh(const Shape& core, double rounding, const Pose& X_BF, const Mesh& mesh, double margin,
                        PairPoints& out);

}  // namespace pincer::contact
