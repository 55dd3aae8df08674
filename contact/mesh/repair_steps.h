// repair_steps: the steps of mesh_repair, each on its own. A step that finds nothing to do
// leaves the mesh as it is and returns nothing.
#pragma once
#include <optional>
#include <vector>

#include "pincer/contact/mesh_repair.h"

namespace pincer::contact {

using MaybeChange = std::optional<MeshChange>;

MaybeChange weldVertices(TriangleMesh& mesh, double distance);  // [m]
MaybeChange dropPointlessTriangles(TriangleMesh& mesh);         // that name a vertex twice
MaybeChange dropDuplicateTriangles(TriangleMesh& mesh);
MaybeChange orientConsistently(TriangleMesh& mesh);
MaybeChange turnFlatTriangles(TriangleMesh& mesh);  // without area: their longest side is turned into the neighbour
MaybeChange cutApart(TriangleMesh& mesh);
MaybeChange fillHoles(TriangleMesh& mesh, int most_edges);
MaybeChange turnOutwards(TriangleMesh& mesh);
MaybeChange dropOpposingNormals(TriangleMesh& mesh);  // of triangles with one that points to their back
MaybeChange dropUnusedVertices(TriangleMesh& mesh);

// Helpers that the steps share.
void dropTriangles(TriangleMesh& mesh, const std::vector<bool>& drop);
// Reverses the marked triangles. Normals of the file that point to the wrong side then are reversed with them.
void flipTriangles(TriangleMesh& mesh, const std::vector<bool>& flip);

}  // namespace pincer::contact
