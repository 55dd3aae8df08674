#include <OpenMesh/Core/Mesh/ArrayKernel.hh>
#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <stdexcept>

#include "pincer/contact/mesh/connectivity.h"

namespace pincer::contact {

namespace {

// Faces and vertices keep the mesh's numbers.
OpenMesh::TriConnectivity halfEdgeMesh(const TriangleMesh& mesh) {
  OpenMesh::TriConnectivity half_edges;
  half_edges.reserve(mesh.vertices.size(), mesh.triangles.size() * 3 / 2 + 3, mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) half_edges.new_vertex();
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto face =
        half_edges.add_face(OpenMesh::VertexHandle(a), OpenMesh::VertexHandle(b), OpenMesh::VertexHandle(c));
    if (!face.is_valid())
      throw std::logic_error(mesh.source + ": a mesh that isn't manifold has come as far as its connectivity");
  }
  return half_edges;
}

std::int8_t edgeFrom(const std::array<std::int32_t, 3>& triangle, std::int32_t vertex) {
  return static_cast<std::int8_t>(triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2);
}

}  // namespace

Neighbours findNeighbours(const TriangleMesh& mesh) {
  const OpenMesh::TriConnectivity half_edges = halfEdgeMesh(mesh);
  Neighbours neighbours(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const auto& half_edge : half_edges.fh_range(OpenMesh::FaceHandle(static_cast<int>(t)))) {
      const auto from = half_edges.from_vertex_handle(half_edge).idx();
      const auto to = half_edges.to_vertex_handle(half_edge).idx();
      const int other = half_edges.face_handle(half_edges.opposite_halfedge_handle(half_edge)).idx();
      if (other < 0) continue;
      const auto edge = static_cast<std::size_t>(edgeFrom(mesh.triangles[t], from));
      neighbours[t][edge] = {other, edgeFrom(mesh.triangles[static_cast<std::size_t>(other)], to)};
    }
  }
  return neighbours;
}

}  // namespace pincer::contact
