#include "pincer/tasks/share/mesh_table.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "pincer/tasks/share/columns.h"

namespace pincer::tasks {
namespace {

bool same(const ViewMesh& a, const ViewMesh& b) {
  return a.closed == b.closed && a.triangles == b.triangles &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](const ViewVertex& v, const ViewVertex& w) { return v.p == w.p && v.n == w.n; });
}

constexpr double kStepsPerSide = 65534;       // as a column has them
constexpr double kStepsPerNormal = 1 / 2e-3;  // a tenth of a degree: no shading shows it

// Corners of neighbouring patches are computed twice and differ by rounding.
using CornerKey = std::array<std::int64_t, 6>;
CornerKey keyOf(const ViewVertex& v, const Vec3f& low, double steps_per_metre) {
  CornerKey key;
  for (int i = 0; i < 3; ++i) {
    key[static_cast<std::size_t>(i)] = static_cast<std::int64_t>((v.p[i] - low[i]) * steps_per_metre + 0.5);
    key[static_cast<std::size_t>(i + 3)] = static_cast<std::int64_t>((v.n[i] + 1) * kStepsPerNormal + 0.5);
  }
  return key;
}

}  // namespace

int MeshTable::add(const ViewMesh& mesh) {
  const auto known =
      std::find_if(meshes_.begin(), meshes_.end(), [&](const ViewMesh& other) { return same(mesh, other); });
  const auto place = static_cast<int>(known - meshes_.begin());
  if (known == meshes_.end()) meshes_.push_back(mesh);
  return place;
}

PageMesh appendMesh(std::string& bytes, const ViewMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const ViewVertex& v : mesh.vertices) box.extend(v.p);
  const double side = box.isEmpty() ? 0 : static_cast<double>(box.sizes().maxCoeff());
  const double steps_per_metre = side > 0 ? kStepsPerSide / side : 0;
  std::map<CornerKey, std::uint32_t> known;
  std::array<std::vector<double>, 6> columns;
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t corner : mesh.triangles) {
    const ViewVertex& v = mesh.vertices[corner];
    const auto [at, is_new] =
        known.emplace(keyOf(v, box.min(), steps_per_metre), static_cast<std::uint32_t>(known.size()));
    indices.push_back(at->second);
    for (int i = 0; is_new && i < 3; ++i) {
      columns[static_cast<std::size_t>(i)].push_back(static_cast<double>(v.p[i]));
      columns[static_cast<std::size_t>(i + 3)].push_back(static_cast<double>(v.n[i]));
    }
  }
  for (const auto& column : columns) appendColumn(bytes, column);
  appendIndices(bytes, indices);
  return {columns[0].size(), indices.size()};
}

}  // namespace pincer::tasks
