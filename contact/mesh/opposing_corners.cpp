#include <map>
#include <utility>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/mesh_topology.h"

namespace pincer::contact {

namespace {

// Calls visit(corner, vertex, normal, area vector) on all corners that have a normal.
template <class Visit>
void forEachNormal(const TriangleMesh& mesh, Visit&& visit) {
  for (std::size_t t = 0; t < mesh.triangle_normals.size(); ++t) {
    const Vec3 area = areaVector(mesh, mesh.triangles[t]);
    for (std::size_t i = 0; i < 3; ++i) {
      if (mesh.triangle_normals[t][i] >= 0) visit(3 * t + i, mesh.triangles[t][i], mesh.triangle_normals[t][i], area);
    }
  }
}

}  // namespace

std::vector<bool> findOpposingCorners(const TriangleMesh& mesh) {
  // of the triangles with a normal at a vertex, where one opposes its own
  std::map<std::pair<std::int32_t, std::int32_t>, Vec3> areas;
  const auto opposes = [&](std::int32_t n, const Vec3& area) {
    return mesh.normals[static_cast<std::size_t>(n)].dot(area) < 0;
  };
  forEachNormal(mesh, [&](std::size_t, std::int32_t vertex, std::int32_t n, const Vec3& area) {
    if (opposes(n, area)) areas.try_emplace({vertex, n}, Vec3::Zero());
  });
  if (areas.empty()) return {};
  forEachNormal(mesh, [&](std::size_t, std::int32_t vertex, std::int32_t n, const Vec3& area) {
    const auto it = areas.find({vertex, n});
    if (it != areas.end()) it->second += area;
  });
  std::vector<bool> opposing(3 * mesh.triangles.size());
  forEachNormal(mesh, [&](std::size_t corner, std::int32_t vertex, std::int32_t n, const Vec3& area) {
    opposing[corner] = opposes(n, area) && opposes(n, areas.at({vertex, n}));
  });
  return opposing;
}

const Vec3* usableFileNormal(const TriangleMesh& mesh, std::size_t t, std::size_t i,
                             const std::vector<bool>& opposing) {
  const std::int32_t n = mesh.triangle_normals[t][i % 3];
  if (n < 0 || (!opposing.empty() && opposing[3 * t + i % 3])) return nullptr;
  return &mesh.normals[static_cast<std::size_t>(n)];
}

}  // namespace pincer::contact
