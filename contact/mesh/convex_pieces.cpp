#include "pincer/contact/mesh/convex_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "pincer/contact/mesh/union_find.h"

namespace pincer::contact {

std::vector<std::shared_ptr<const Polytope>> hullsOfPieces(const TriangleMesh& mesh) {
  UnionFind joined(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) joined.join(a, b), joined.join(b, c);
  std::map<std::int32_t, std::size_t> number;  // of a piece, by the vertex that stands for it
  std::vector<std::vector<Vec3>> pieces;
  std::vector<bool> is_taken(mesh.vertices.size(), false);
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t vertex : triangle) {
      if (is_taken[static_cast<std::size_t>(vertex)]) continue;
      is_taken[static_cast<std::size_t>(vertex)] = true;
      const auto [place, is_new] = number.emplace(joined.find(vertex), pieces.size());
      if (is_new) pieces.emplace_back();
      pieces[place->second].push_back(mesh.vertices[static_cast<std::size_t>(vertex)]);
    }
  }
  std::vector<std::shared_ptr<const Polytope>> hulls;
  for (const std::vector<Vec3>& points : pieces)
    hulls.push_back(Polytope::hullOf(points, fmt::format("{}, piece {}", mesh.source, hulls.size())));
  return hulls;
}

namespace {

double longestSideOf(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

// The distance to the nearest face's plane, as far as one is further than `least` from all [m].
double depthIn(const Polytope& hull, const Vec3& p, double least) {
  double depth = kInfinity;
  for (const Polytope::Face& face : hull.faces()) {
    depth = std::min(depth, face.d - face.n.dot(p));
    if (depth <= least) break;
  }
  return depth;
}

void requireConvex(const TriangleMesh& part, const Polytope& hull) {
  constexpr double kShallow = 0.01;  // of its size: dents of drawn and of rounded solids
  const double least = kShallow * longestSideOf(part.vertices);
  for (const Vec3& p : part.vertices) {
    const double depth = depthIn(hull, p, least);
    if (!(depth > least)) continue;
    throw InputError(
        fmt::format("{} isn't convex: its vertex at ({:.4g}, {:.4g}, {:.4g}) m lies {:.3g} mm inside its hull. Cut it "
                    "into convex parts, or make it a shape of its own: {{\"type\": \"mesh\", \"part\": ..}}.",
                    part.source, p.x(), p.y(), p.z(), 1e3 * depth));
  }
}

}  // namespace

std::vector<std::shared_ptr<const Polytope>> hullsOfGroups(const std::vector<MeshGroup>& groups) {
  std::vector<std::shared_ptr<const Polytope>> hulls;
  for (const MeshGroup& group : groups) {
    hulls.push_back(Polytope::hullOf(group.mesh.vertices, group.mesh.source));
    requireConvex(group.mesh, *hulls.back());
  }
  return hulls;
}

}  // namespace pincer::contact
