#include <fmt/format.h>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

bool opposes(const std::vector<bool>& corners, std::size_t t) {
  return corners[3 * t] || corners[3 * t + 1] || corners[3 * t + 2];
}

}  // namespace

Occurrences<std::int32_t> findOpposingNormals(const TriangleMesh& mesh) {
  Occurrences<std::int32_t> opposing;
  const std::vector<bool> corners = findOpposingCorners(mesh);
  for (std::size_t t = 0; t < corners.size() / 3; ++t) {
    if (opposes(corners, t)) opposing.add(static_cast<std::int32_t>(t));
  }
  return opposing;
}

MaybeChange dropOpposingNormals(TriangleMesh& mesh) {
  const Occurrences<std::int32_t> opposing = findOpposingNormals(mesh);
  if (opposing.count == 0) return {};
  const std::vector<bool> corners = findOpposingCorners(mesh);
  bool any_left = false;
  for (std::size_t t = 0; t < mesh.triangle_normals.size(); ++t) {
    auto& normals = mesh.triangle_normals[t];
    if (opposes(corners, t)) normals = {-1, -1, -1};  // OBJ knows no triangle with normals at some of its corners
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
