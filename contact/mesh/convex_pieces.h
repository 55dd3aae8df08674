// convex_pieces: a file of convex pieces, as decompositions write them (CoACD, V-HACD) one after the other, or as
// people draw them, each under a name of its own.
#pragma once
#include <memory>
#include <vector>

#include "pincer/contact/mesh/mesh_groups.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// The hull of each part of the mesh whose triangles hang together by their vertices, in the order of their first
// triangles; a piece that isn't convex counts as its hull. Vertices without a triangle belong to none. Throws
// InputError where a piece has no hull (Polytope::hullOf).
std::vector<std::shared_ptr<const Polytope>> hullsOfPieces(const TriangleMesh& mesh);

// The hull of each named part, in their order. Throws InputError where a part has no hull, or isn't convex: a vertex
// lies further inside its hull than a hundredth of the hull's size.
std::vector<std::shared_ptr<const Polytope>> hullsOfGroups(const std::vector<MeshGroup>& groups);

}  // namespace pincer::contact
