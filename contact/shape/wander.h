// wander: how far the place at which a flat pad touches a curved surface goes as the body turns.
//
//   A = dn/dc,   kappa_i = a_i / (1 - h a_i),   W = sum_i (1 / kappa_i) (n x e_i)(n x e_i)^T
//
//   c     centre of the pad's ball, c = s + h n(s);  n the surface's normal over it,  h = phi + rounding [m]
//   a, e  eigenvalues and directions of A in the tangent plane [1/m]
//   W     the body, turned by theta past the pad, is touched at  s + (W theta) x n  [m]: under the load f that is the
//         torque -f W theta
//
// From two queries beside the place. On an edge kappa is endless, and W = 0 across it, as where the surface is hollow;
// what is flat counts as nearly flat.
#pragma once
#include "pincer/contact/shape.h"
#include "pincer/contact/surface_contact.h"

namespace pincer::contact {

// At the contact `main` of a ball of radius `r` [m]. `step`: how far beside it is asked [m]; `tracker` stands at
// `main`. Allocates nothing.
Mat3 wanderAt(const Shape& shape, const SurfaceContact& main, double r, double step, const SurfaceTracker& tracker,
              PatchCache& cache);

}  // namespace pincer::contact
