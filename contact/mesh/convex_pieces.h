// convex_pieces: a file of convex pieces, as decompositions write them (CoACD, V-HACD), one after the other.
#pragma once
#include <memory>
#include <vector>

#include "pincer/contact/polytope.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// The hull of each part of the mesh whose triangles hang together by their vertices, in the order of their first
// triangles; a piece that isn't convex counts as its hull. Vertices without a triangle belong to none. Throws
// InputError where a piece has no hull (Polytope::hullOf).
std::vector<std::shared_ptr<const Polytope>> hullsOfPieces(const TriangleMesh& mesh);

}  // namespace pincer::contact
