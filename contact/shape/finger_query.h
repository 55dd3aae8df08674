// finger_query: where a fingertip sphere touches a shape.
//
//   p_BS  the surface point, n_B the outward normal of the body there, both in the body's frame B
//   phi   signed gap between fingertip and surface [m]: phi = (p_BC - p_BS) . n_B - r, negative when they overlap
//
// The finger's centre lies on the normal over the surface point: p_BC = p_BS + (phi + r) n_B, for every shape but meshes with force shading,
// whose n_B is that of the force, not of the facet touched (flat_contact.h).
#pragma once
#include "contact/math.h"
#include "contact/shape/shape.h"
#include "contact/surface/patch_cache.h"
#include "contact/surface/surface_contact.h"

namespace pincer::contact {

// Contacts of a sphere of radius `r` > 0 [m] centred at `p_BC` with `shape`: the main one, whatever its gap, then up to two further ones
// nearer than `margin` >= 0 [m]. Total: for a centre on the medial axis of a primitive one of the nearest points is chosen, always the
// same one. Allocates nothing; `cache` is memory only.
SurfaceContacts querySphere(const Shape& shape, const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker, PatchCache& cache);

// A lower bound of phi that costs next to nothing (bounding sphere), for skipping fingers that are far away. [m]
double lowerBoundOfGap(const Shape& shape, const Vec3& p_BC, double r);

}  // namespace pincer::contact
