// edge_weights: by how much one end's normal outweighs the other's along an edge of a flat facet.
//
//   omega(x) = 1 + g . x,   omega(x_c) n_c . e  as nearly affine in x over the facet's corners c as it can be
//   along an edge   N(s) ~ (1 - s) omega0 n0 + s omega1 n1,   w = omega0 / omega1
//
//   x  place in the facet's plane, from one of its corners [m], g  the smallest that fits [1/m], n  shading normals,
//   e  unit vector in the plane, along the arc on which they lie [-]
//
// Triangles of one plane are one facet, and how it was cut is no property of the shape: its normals follow from all of
// its corners. On a cone rulings meet, so the middle of a quad's diagonal isn't half way around; with even weights
// contact runs at .87 to 1.11 of its speed. There omega is the distance from the tip, and the normals are the cone's
// own all over the quad, whichever way its diagonal runs. On cylinders rulings don't meet: omega = 1. So it is where
// there are none, for normals that turn both ways (g fades to 0), facets that lie in one plane by chance, and single
// triangles. At the tip of a round cone (cone_tips.h) no normal exists: there omega is kTip times its neighbours', so
// that the rulings keep their normals to the end. Projective weights as in rational curves: G. Farin, "Curves and
// Surfaces for CAGD", 5th ed., 2002, ch. 13.
#pragma once
#include <array>
#include <vector>

#include "pincer/contact/mesh/connectivity.h"

namespace pincer::contact {

// Per triangle and edge: w - 1 where the first end outweighs the second, 1 - 1/w where it is the other way around [-].
// Seen from a smooth edge's other side the sign changes, and no bit else. Empty if all are even.
using EdgeWeights = std::vector<std::array<float, 3>>;
EdgeWeights findEdgeWeights(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners);

}  // namespace pincer::contact
