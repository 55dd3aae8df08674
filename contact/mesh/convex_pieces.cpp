#include "pincer/contact/mesh/convex_pieces.h"

#include <fmt/format.h>

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

}  // namespace pincer::contact
