// published_iteration: the contact of smooth_published, by the iteration as it was printed; for comparison only.
//
//   R = C - S, h = R.n, T = R - h n;   step  g (du, dv),  g = Gain / ((1 + G_k k) (1 + G_d d)),
//   Gain = 1, G_k = r, G_d = 0
//
//   T        what is left across the unit normal n [m]
//   du, dv   its direction in the flat triangle's barycentric coordinates [-]
//   k        curvature along the step, |dn| / |dS| [1/m];  r  fingertip radius [m]
//   d        |r - h|, which has no part with G_d = 0
//
// Across an edge the rest of the step is turned with the facets about it. It ends where |T| < 1 um, and fails after 50
// steps: always where the contact is a crease, on which no surface point fulfils the equation. Its error shrinks by 1 -
// g (1 + k h) per step, so it takes 2 to 3. Source: A. J. Doxon et al., Presence 20(6), 2011.
#pragma once
#include "pincer/contact/surface/shell_solver.h"

namespace pincer::contact {

// Allocates nothing, throws nothing; cost.steps counts the iterations.
ShellContact followPublished(const SurfaceNet& net, PatchCache& cache, const Vec3& C, double r, const Foot& start);

}  // namespace pincer::contact
