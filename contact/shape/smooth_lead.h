// smooth_lead: from points of contact with a mesh's flat triangles to those with the smooth surface over them.
//
//   c = P_F(c - tau N(c))  for every tau > 0,   c - S = h N(c),   phi = h - rho
//
//   F, rho  feature of the convex solid that is touched, and the radius about it
//           (solid_feature.h);  P_F  nearest point of F
//   S, N    place of the smooth surface and its unit normal over which c lies
//           (surface/shell_solver.h);  h  c's height there [m]
//
// This is the equation of fingers (finger_query.h) on a part of the solid: the height over the surface is least along
// F. It is solved by the same projected gradient steps, from the place where the flat triangles are touched; over the
// edges between triangles the surface is continuous, so no answer tells where they are.
//
//   | point of the flat mesh | is led |
//   |---|---|
//   | on a triangle, or on an edge or corner between smooth patches | along the corner,
//   edge or face of the solid that it is on |
//   | on a crease or a corner | not: it is a point of the surface as it is |
//   | on a flat patch | not: it is there |
//   | the deepest of those with like normals, but on flat patches | also over all of the
//   solid's face or line that faces the surface |
//
// So what lies on a surface keeps its corners, and what touches a bulge does so at its highest place, wherever the
// facets end. Points that are led to one place are one. Edge: where the surface is all but level over more than a facet
// along F (the top circle of a torus of 500 triangles under a capsule that crosses it askew), its shading and its shape
// differ by some micrometres, and contact passes from place to place with that much of a step.
#pragma once
#include <span>

#include "pincer/contact/shape/contact_candidates.h"
#include "pincer/contact/shape/posed_solid.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

// Leads `points` on the mesh, all in its frame, normals out of the solid, in place. `size` [m] of the smaller body.
// Allocates nothing.
void leadToSurface(const SurfaceNet& net, PatchCache& cache, const PosedSolid& solid, double size, double margin,
                   FoundPoints& points);

}  // namespace pincer::contact
