#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "pincer/contact/io/counted.h"
#include "pincer/contact/mesh/mesh_findings.h"
#include "pincer/contact/mesh/mesh_topology.h"
#include "pincer/contact/mesh/polygon.h"
#include "pincer/contact/mesh/repair_steps.h"

namespace pincer::contact {

namespace {

using Triangle = std::array<std::int32_t, 3>;

const HalfEdge* firstBetween(const std::vector<HalfEdge>& half_edges, std::int32_t a, std::int32_t b) {
  const auto [low, high] = std::minmax(a, b);
  const auto it =
      std::lower_bound(half_edges.begin(), half_edges.end(), std::make_tuple(low, high),
                       [](const HalfEdge& h, const auto& key) { return std::make_tuple(h.low, h.high) < key; });
  return it != half_edges.end() && it->low == low && it->high == high ? &*it : nullptr;
}

std::span<const HalfEdge> edgeBetween(const std::vector<HalfEdge>& half_edges, std::int32_t a, std::int32_t b) {
  const HalfEdge* first = firstBetween(half_edges, a, b);
  return first ? edgeAt(half_edges, static_cast<std::size_t>(first - half_edges.data())) : std::span<const HalfEdge>();
}

// True if two triangles with the same vertices face the same way: one is the other, turned on.
bool faceSameWay(const Triangle& a, const Triangle& b) {
  const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  return b[(at + 1) % 3] == a[1];
}

// How many of `equal` triangles belong to the surface: one if it would have a hole without (an odd number of others at
// its edges), or if they are all the same sheet; none if they are the two sides of a sheet inside or on its own.
bool oneBelongs(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges,
                const std::vector<std::int32_t>& equal) {
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(equal[0])];
  int odd = 0, alone = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t others = edgeBetween(half_edges, t[i], t[(i + 1) % 3]).size() - equal.size();
    odd += others % 2 == 1;
    alone += others == 0;
  }
  const auto same = [&](std::int32_t other) { return faceSameWay(t, mesh.triangles[static_cast<std::size_t>(other)]); };
  if (alone == 3) return std::all_of(equal.begin(), equal.end(), same);
  return odd >= 2 || equal.size() % 2 == 1;
}

// Turns sides of triangles without area until there is nothing more to turn.
class FlatTriangles {
 public:
  explicit FlatTriangles(TriangleMesh& mesh) : mesh_(mesh) {}

  Occurrences<std::string> remove() {
    constexpr int kMostPasses = 20;  // a row of flat triangles loses one per pass
    for (int pass = 0; pass < kMostPasses && turnAll(); ++pass) continue;
    return removed_;
  }

 private:
  bool isFlat(std::size_t t) const {
    const Triangle& v = mesh_.triangles[t];
    return hasZeroArea(at(v[0]), at(v[1]), at(v[2]));
  }
  const Vec3& at(std::int32_t v) const { return mesh_.vertices[static_cast<std::size_t>(v)]; }

  bool turnAll() {
    std::vector<std::size_t> flat;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (isFlat(t)) flat.push_back(t);
    }
    if (flat.empty()) return false;
    half_edges_ = sortedHalfEdges(mesh_.triangles);
    touched_.assign(mesh_.triangles.size(), false);
    drop_.assign(mesh_.triangles.size(), false);
    const int before = removed_.count;
    for (const std::size_t t : flat) {
      if (!touched_[t]) turn(t);
    }
    dropTriangles(mesh_, drop_);
    return removed_.count > before;
  }

  std::size_t longestSide(const Triangle& v) const {
    std::size_t longest = 0;
    const auto length2 = [&](std::size_t i) { return (at(v[(i + 1) % 3]) - at(v[i])).squaredNorm(); };
    for (std::size_t i = 1; i < 3; ++i) {
      if (length2(i) > length2(longest)) longest = i;
    }
    return longest;
  }

  void turn(std::size_t t) {
    const std::size_t i = longestSide(mesh_.triangles[t]);
    const std::int32_t u = mesh_.triangles[t][i], v = mesh_.triangles[t][(i + 1) % 3],
                       m = mesh_.triangles[t][(i + 2) % 3];
    const auto edge = edgeBetween(half_edges_, u, v);
    if (isBoundary(edge)) return drop(t);
    if (!isRegular(edge)) return;
    const HalfEdge& across = edge[0].triangle == static_cast<std::int32_t>(t) ? edge[1] : edge[0];
    const auto s = static_cast<std::size_t>(across.triangle), j = static_cast<std::size_t>(across.side);
    if (touched_[s]) return;
    const std::int32_t d = mesh_.triangles[s][(j + 2) % 3];
    if (d == m) {
      drop_[s] = touched_[s] = true;
      return drop(t);
    }
    if (firstBetween(half_edges_, d, m)) return;
    note(t);
    touched_[t] = touched_[s] = true;
    setTriangles(t, i, s, j);
  }

  // (u, v, m) and (v, u, d) become (u, d, m) and (d, v, m). Normals of the file at u, v and d, and its
  // smoothing group, are the whole neighbour's.
  void setTriangles(std::size_t t, std::size_t i, std::size_t s, std::size_t j) {
    const auto turned = [&](std::vector<Triangle>& list) {
      const std::int32_t v = list[s][j], u = list[s][(j + 1) % 3], d = list[s][(j + 2) % 3], m = list[t][(i + 2) % 3];
      list[t] = {u, d, m};
      list[s] = {d, v, m};
    };
    turned(mesh_.triangles);
    if (!mesh_.triangle_normals.empty()) turned(mesh_.triangle_normals);
    if (!mesh_.smoothing_groups.empty()) mesh_.smoothing_groups[t] = mesh_.smoothing_groups[s];
  }

  void note(std::size_t t) { removed_.add(trianglePlace(mesh_, static_cast<std::int32_t>(t))); }
  void drop(std::size_t t) {
    note(t);
    drop_[t] = touched_[t] = true;
  }

  TriangleMesh& mesh_;
  std::vector<HalfEdge> half_edges_;
  std::vector<bool> touched_, drop_;
  Occurrences<std::string> removed_;
};

}  // namespace

void dropTriangles(TriangleMesh& mesh, const std::vector<bool>& drop) {
  const auto keepOthers = [&](auto& list) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < drop.size(); ++t) {
      if (!drop[t]) list[kept++] = list[t];
    }
    list.resize(kept);
  };
  keepOthers(mesh.triangles);
  if (!mesh.triangle_normals.empty()) keepOthers(mesh.triangle_normals);
  if (!mesh.smoothing_groups.empty()) keepOthers(mesh.smoothing_groups);
}

MaybeChange dropPointlessTriangles(TriangleMesh& mesh) {
  Occurrences<std::int32_t> pointless;
  std::vector<bool> drop(mesh.triangles.size());
  for (std::size_t t = 0; t < drop.size(); ++t) {
    drop[t] = namesAVertexTwice(mesh.triangles[t]);
    if (drop[t]) pointless.add(static_cast<std::int32_t>(t));
  }
  if (pointless.count == 0) return {};
  const std::string first = trianglePlace(mesh, pointless.first);
  dropTriangles(mesh, drop);
  return MeshChange{"dropped-degenerate-triangles", pointless.count,
                    fmt::format("dropped {} two of whose corners are one; the first was {}",
                                counted(pointless.count, "triangle"), first)};
}

MaybeChange dropDuplicateTriangles(TriangleMesh& mesh) {
  const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh.triangles);
  Occurrences<std::int32_t> duplicates;
  std::vector<bool> drop(mesh.triangles.size());
  for (const std::vector<std::int32_t>& equal : equalTriangles(mesh, half_edges)) {
    for (std::size_t k = oneBelongs(mesh, half_edges, equal); k < equal.size(); ++k) {
      drop[static_cast<std::size_t>(equal[k])] = true;
      duplicates.add(equal[k]);
    }
  }
  if (duplicates.count == 0) return {};
  const std::string first = trianglePlace(mesh, duplicates.first);
  dropTriangles(mesh, drop);
  return MeshChange{
      "dropped-duplicate-faces", duplicates.count,
      fmt::format("dropped {} on top of others; the first was {}", counted(duplicates.count, "triangle"), first)};
}

MaybeChange turnFlatTriangles(TriangleMesh& mesh) {
  const Occurrences<std::string> removed = FlatTriangles(mesh).remove();
  if (removed.count == 0) return {};
  return MeshChange{"removed-flat-triangles", removed.count,
                    fmt::format("removed {} without area, without a gap; the first was {}",
                                counted(removed.count, "triangle"), removed.first)};
}

}  // namespace pincer::contact
