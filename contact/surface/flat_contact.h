// flat_contact: contact with the triangles as they are; the baseline that shading is compared with.
//
//   phi = (C - p) . n_f - r,   S = C - (phi + r) n_f      p  any point of facet f, n_f  its unit normal; frame B
//
// f is the facet of the mesh's point that is nearest to the fingertip's centre C, found by descent from facet to facet,
// so that it is followed. Where that point lies on an edge or a vertex, f is the adjacent facet that C is highest above
// (below the surface: deepest under): the facets' offset planes meet in mitres, as they do for a god-object. Within a
// facet the normal is constant; from one to the next depth is continuous and the normal jumps by the angle theta
// between them, the contact on the fingertip by r theta. An open border is rolled over, as in shell_edge.h.
//
// `force` has the same contact point, but its force along the normal interpolated from the facet's corners: n = sum b_i
// n_i / |sum b_i n_i|. Sources: C. Zilles, J. K. Salisbury, "A constraint-based god-object method", IROS 1995; H.-B.
// Morgenbesser, M. A. Srinivasan, "Force shading for haptic shape perception", ASME DSC-58, 1996; sign at a vertex: J.
// A. Baerentzen, H. Aanaes, IEEE TVCG 11(3), 2005.
#pragma once
#include "pincer/contact/surface/shell_solver.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// Follows the contact of centre `C` from `start`. Not converged after 200 facets. Allocates nothing, throws nothing.
ShellContact followFlat(const SurfaceNet& net, const Vec3& C, const Foot& start);

// Turns the contacts' normals to the interpolated ones; those that a border
// deflects stay. `tracker` is that of the query.
void shadeForce(const SurfaceNet& net, const SurfaceTracker& tracker, SurfaceContacts& contacts);

}  // namespace pincer::contact
