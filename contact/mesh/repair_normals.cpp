#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

bool hasOpposingNormal(const TriangleMesh& mesh, std::size_t t) {
  const Vec3 facet = areaVector(mesh, mesh.triangles[t]);
  const auto opposes = [&](std::int32_t n) { return n >= 0 && mesh.normals[static_cast<std::size_t>(n)].dot(facet) < 0; };
  const auto& normals = mesh.triangle_normals[t];
  return std::any_of(normals.begin(), normals.end(), opposes);
}

}  // namespace

Occurrences<std::int32_t> findOpposingNormals(const TriangleMesh& mesh) {
  Occurrences<std::int32_t> opposing;
  for (std::size_t t = 0; t < mesh.triangle_normals.size(); ++t) {
    if (hasOpposingNormal(mesh, t)) opposing.add(static_cast<std::int32_t>(t));
  }
  return opposing;
}

MaybeChange dropOpposingNormals(TriangleMesh& mesh) {
  const Occurrences<std::int32_t> opposing = findOpposingNormals(mesh);
  if (opposing.count == 0) return {};
  bool any_left = false;
  for (std::size_t t = 0; t < mesh.triangle_normals.size(); ++t) {
    auto& normals = mesh.triangle_normals[t];
    if (hasOpposingNormal(mesh, t)) normals = {-1, -1, -1};  // OBJ knows no triangle with normals at some of its corners
    any_left = any_left || normals[0] >= 0 || normals[1] >= 0 || normals[2] >= 0;
  }
  if (!any_left) {
    mesh.normals.clear();
    mesh.triangle_normals.clear();
  }
  return MeshChange{"dropped-normals", opposing.count,
                    fmt::format("dropped the file's normals of {} that have one to their back; the first is {}",
                                counted(opposing.count, "triangle"), trianglePlace(mesh, opposing.first))};
}

}  // namespace pincer::contact
