// mesh_findings: the sentences of mesh_report, one function per kind of defect. Each names the first place, by element
// and in millimetres, and what helps; none returns anything where there is nothing to say.
#pragma once
#include <optional>
#include <string>

#include "pincer/contact/mesh/mesh_pieces.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh_report.h"

namespace pincer::contact {

// "vertex 17 at (1, 2, 3) mm", counted from 1 as mesh files do; "the edge from vertex ... to
// vertex ..."; "triangle 5 at (1, 2, 3) mm".
std::string vertexPlace(const TriangleMesh& mesh, std::int32_t vertex);
std::string edgePlace(const TriangleMesh& mesh, const VertexPair& edge);
std::string trianglePlace(const TriangleMesh& mesh, std::int32_t triangle);

using MaybeFinding = std::optional<MeshFinding>;

MaybeFinding boundaryFinding(const TriangleMesh& mesh, const MeshTopology& topology);
MaybeFinding branchingFinding(const TriangleMesh& mesh, const MeshTopology& topology);
MaybeFinding reversedFinding(const TriangleMesh& mesh, const MeshTopology& topology);
MaybeFinding touchingFinding(const TriangleMesh& mesh, const MeshTopology& topology);
MaybeFinding flippedPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces);
MaybeFinding nestedPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces);
MaybeFinding severalPiecesFinding(const TriangleMesh& mesh, const MeshPieces& pieces);
MaybeFinding duplicateVertexFinding(const TriangleMesh& mesh, const std::vector<std::int32_t>& first_at_place);
MaybeFinding unusedVertexFinding(const TriangleMesh& mesh, const std::vector<bool>& used);
MaybeFinding zeroAreaFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles);
MaybeFinding needleFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles);
MaybeFinding duplicateTriangleFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles);
// Triangles with a normal of the file that points to their back.
Occurrences<std::int32_t> findOpposingNormals(const TriangleMesh& mesh);
MaybeFinding opposingNormalFinding(const TriangleMesh& mesh, const Occurrences<std::int32_t>& triangles);
MaybeFinding flatPieceFinding(const TriangleMesh& mesh, const MeshPieces& pieces);
MaybeFinding sizeFinding(double size, double metres_per_unit);

}  // namespace pincer::contact
