#include <fmt/format.h>

#include <map>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_pieces.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

// Which triangles must be flipped so that neighbours agree: of two ways per piece the one with fewer flips. Edges where
// the surface branches don't count as neighbourhood. A piece with one side only (a Moebius strip) is left as it is.
class Orientation {
 public:
  explicit Orientation(const TriangleMesh& mesh)
      : across_(3 * mesh.triangles.size()), flip_(mesh.triangles.size()), seen_(flip_.size()) {
    forEachEdge(sortedHalfEdges(mesh.triangles), [&](auto edge) {
      if (edge.size() != 2) return;
      link(edge[0], edge[1].triangle, isReversed(edge));
      link(edge[1], edge[0].triangle, isReversed(edge));
    });
  }

  std::vector<bool> find() {
    for (std::size_t t = 0; t < flip_.size(); ++t) {
      if (!seen_[t]) orientPiece(static_cast<std::int32_t>(t));
    }
    return flip_;
  }

 private:
  struct Link {
    std::int32_t triangle = -1;
    bool reversed = false;
  };

  void link(const HalfEdge& h, std::int32_t other, bool reversed) {
    across_[static_cast<std::size_t>(3 * h.triangle + h.side)] = {other, reversed};
  }

  void orientPiece(std::int32_t first) {
    std::vector<std::int32_t> piece = {first};
    seen_[static_cast<std::size_t>(first)] = true;
    bool one_sided = false;
    std::size_t flips = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const auto t = static_cast<std::size_t>(piece[k]);
      flips += flip_[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const Link& next = across_[3 * t + i];
        if (next.triangle < 0) continue;
        const auto s = static_cast<std::size_t>(next.triangle);
        const bool wanted = flip_[t] != next.reversed;
        if (seen_[s]) {
          one_sided |= flip_[s] != wanted;
          continue;
        }
        seen_[s] = true;
        flip_[s] = wanted;
        piece.push_back(next.triangle);
      }
    }
    const bool other_way = 2 * flips > piece.size();
    for (const std::int32_t t : piece) {
      const auto i = static_cast<std::size_t>(t);
      flip_[i] = !one_sided && flip_[i] != other_way;
    }
  }

  std::vector<Link> across_;
  std::vector<bool> flip_, seen_;
};

MaybeChange flipMarked(TriangleMesh& mesh, const std::vector<bool>& flip, const char* name, const char* what) {
  Occurrences<std::int32_t> flipped;
  for (std::size_t t = 0; t < flip.size(); ++t) {
    if (flip[t]) flipped.add(static_cast<std::int32_t>(t));
  }
  if (flipped.count == 0) return {};
  flipTriangles(mesh, flip);
  return MeshChange{name, flipped.count,
                    fmt::format("flipped {} {}; the first is {}", counted(flipped.count, "triangle"), what,
                                trianglePlace(mesh, flipped.first))};
}

}  // namespace

void flipTriangles(TriangleMesh& mesh, const std::vector<bool>& flip) {
  std::map<std::int32_t, std::int32_t> opposite;  // of a normal
  for (std::size_t t = 0; t < flip.size(); ++t) {
    if (!flip[t]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (mesh.triangle_normals.empty()) continue;
    auto& normals = mesh.triangle_normals[t];
    std::swap(normals[1], normals[2]);
    const Vec3 facet = areaVector(mesh, mesh.triangles[t]);
    for (std::int32_t& n : normals) {
      if (n < 0 || mesh.normals[static_cast<std::size_t>(n)].dot(facet) >= 0) continue;
      const auto [it, is_new] = opposite.try_emplace(n, static_cast<std::int32_t>(mesh.normals.size()));
      if (is_new) mesh.normals.push_back(Vec3(-mesh.normals[static_cast<std::size_t>(n)]));
      n = it->second;
    }
  }
}

MaybeChange orientConsistently(TriangleMesh& mesh) {
  return flipMarked(mesh, Orientation(mesh).find(), "flipped-triangles",
                    "that faced another way than their neighbours");
}

MaybeChange turnOutwards(TriangleMesh& mesh) {
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh.triangles);
  const MeshTopology topology = findTopology(mesh, half_edges);
  const MeshPieces pieces = findPieces(mesh, half_edges, topology);
  if (!pieces.nesting_known) return {};  // a piece that faces inwards may be a cavity
  std::vector<bool> flip(mesh.triangles.size());
  for (std::size_t t = 0; t < flip.size(); ++t) {
    flip[t] = topology.piece_of[t] >= 0 && pieces.list[static_cast<std::size_t>(topology.piece_of[t])].facesInwards();
  }
  return flipMarked(mesh, flip, "turned-pieces", "of closed pieces that faced inwards");
}

}  // namespace pincer::contact
