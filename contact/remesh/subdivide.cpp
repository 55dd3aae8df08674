#include <fmt/format.h>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/mesh_builder.h"
#include "pincer/contact/mesh_report.h"
#include "pincer/contact/remesh/simplify.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch.h"

namespace pincer::contact {

namespace {

class Subdivision {
 public:
  Subdivision(const TriangleMesh& mesh, const SmoothMesh& surface)
      : mesh_(mesh), surface_(surface), neighbours_(findNeighbours(mesh)), middles_(mesh.triangles.size()) {}

  TriangleMesh run() {
    result_.source = mesh_.source;
    result_.vertices = mesh_.vertices;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) split(t);
    return std::move(result_);
  }

 private:
  void split(std::size_t t) {
    // 0, 1, 2 corners; 3, 4, 5 middles of the edges 0-1, 1-2, 2-0.
    constexpr std::array<std::array<std::size_t, 3>, 4> kParts = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
    const Patch patch = surface_.patch(static_cast<std::int32_t>(t));
    const auto& corners = mesh_.triangles[t];
    std::array<std::int32_t, 6> vertices = {corners[0], corners[1], corners[2], 0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) vertices[3 + i] = middleOf(t, i, patch);
    const auto first = static_cast<std::int32_t>(result_.normals.size());
    for (const Vec3& n : {patch.n200, patch.n020, patch.n002}) result_.normals.push_back(n);
    for (const auto& [u, v] : {std::array{0.5, 0.0}, std::array{0.5, 0.5}, std::array{0.0, 0.5}}) {
      result_.normals.push_back(evaluate(patch, u, v).N.normalized());
    }
    const auto at = [](std::size_t i) { return static_cast<std::int32_t>(i); };
    for (const auto& [a, b, c] : kParts) {
      result_.triangles.push_back({vertices[a], vertices[b], vertices[c]});
      result_.triangle_normals.push_back({first + at(a), first + at(b), first + at(c)});
    }
  }

  // Both sides of an edge share its middle; the first that comes makes it.
  std::int32_t middleOf(std::size_t t, std::size_t i, const Patch& patch) {
    const Neighbour other = neighbours_[t][i];
    if (other.triangle >= 0 && static_cast<std::size_t>(other.triangle) < t) {
      return middles_[static_cast<std::size_t>(other.triangle)][static_cast<std::size_t>(other.edge)];
    }
    const auto curve = edgeCurve(patch, static_cast<int>(i));
    middles_[t][i] = static_cast<std::int32_t>(result_.vertices.size());
    result_.vertices.push_back(Vec3(0.125 * (curve[0] + 3 * (curve[1] + curve[2]) + curve[3])));
    return middles_[t][i];
  }

  const TriangleMesh& mesh_;
  const SmoothMesh& surface_;
  const Neighbours neighbours_;
  std::vector<std::array<std::int32_t, 3>> middles_;  // per triangle and edge
  TriangleMesh result_;
};

}  // namespace

TriangleMesh subdivide(const TriangleMesh& mesh, double crease_angle, bool use_file_normals) {
  if (4 * mesh.triangles.size() > kMaxTriangles) {
    throw InputError(
        fmt::format("{}: subdivided it would have {} triangles; the limit is {}. A finger doesn't feel finer ones.",
                    mesh.source, 4 * mesh.triangles.size(), kMaxTriangles));
  }
  const auto surface = SmoothMesh::build(mesh, {.crease_angle = crease_angle, .use_file_normals = use_file_normals});
  return Subdivision(mesh, *surface).run();
}

}  // namespace pincer::contact
