#include "contact/surface/mesh_features.h"

namespace pincer::contact {
namespace {

const Vec3& vertexOf(const TriangleMesh& mesh, std::int32_t v) { return mesh.vertices[static_cast<std::size_t>(v)]; }

Vec3 normalOf(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t) {
  return (vertexOf(mesh, t[1]) - vertexOf(mesh, t[0])).cross(vertexOf(mesh, t[2]) - vertexOf(mesh, t[0]));
}

std::vector<Aabb> boxesOf(const TriangleMesh& mesh) {
  std::vector<Aabb> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = vertexOf(mesh, t[0]), &b = vertexOf(mesh, t[1]), &c = vertexOf(mesh, t[2]);
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
  }
  return boxes;
}

}  // namespace

MeshFeatures::MeshFeatures(const TriangleMesh& mesh, const Neighbours& neighbours)
    : owned_(mesh.triangles.size(), 0), opposite_(mesh.triangles.size()), tree_(boxesOf(mesh)) {
  constexpr double kFlat = 1e-6;  // sine of the angle across an edge that counts as none
  std::vector<bool> taken(mesh.vertices.size(), false);
  for (std::size_t t = 0; t < owned_.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const Vec3 n = normalOf(mesh, corners);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = static_cast<std::size_t>(corners[i]);
      if (!taken[v]) owned_[t] |= static_cast<std::uint8_t>(1u << i);
      taken[v] = true;
      const Neighbour& other = neighbours[t][i];
      opposite_[t][i] = -1;
      if (other.triangle < 0) continue;
      const std::int32_t beyond = mesh.triangles[static_cast<std::size_t>(other.triangle)][(static_cast<std::size_t>(other.edge) + 2) % 3];
      opposite_[t][i] = beyond;
      const Vec3 across = vertexOf(mesh, beyond) - vertexOf(mesh, corners[i]);
      const bool convex = n.dot(across) < -kFlat * n.norm() * across.norm();
      if (convex && other.triangle > static_cast<std::int32_t>(t)) owned_[t] |= static_cast<std::uint8_t>(8u << i);
    }
  }
}

MeshFeatures::Triangle MeshFeatures::triangle(const TriangleMesh& mesh, std::int32_t t) const {
  const auto at = static_cast<std::size_t>(t);
  const auto& v = mesh.triangles[at];
  Triangle triangle{{vertexOf(mesh, v[0]), vertexOf(mesh, v[1]), vertexOf(mesh, v[2])}, normalOf(mesh, v).normalized(), v, owned_[at], {}};
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangle.ownsEdge(static_cast<int>(i))) triangle.beyond[i] = vertexOf(mesh, opposite_[at][i]);
  }
  return triangle;
}

}  // namespace pincer::contact
