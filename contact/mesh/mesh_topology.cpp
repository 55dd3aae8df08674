#include "pincer/contact/mesh/mesh_topology.h"

#include <algorithm>
#include <numeric>

#include "pincer/contact/functions/invariants.h"

namespace pincer::contact {

namespace {

VertexPair endsOf(std::span<const HalfEdge> edge) { return {edge[0].low, edge[0].high}; }

void countTouchingVertices(const TriangleMesh& mesh, UnionFind& fans, MeshTopology& topology) {
  std::vector<std::int32_t> fan_of(mesh.vertices.size(), -1);
  std::vector<bool> touching(mesh.vertices.size());
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    if (namesAVertexTwice(mesh.triangles[c / 3])) continue;
    const auto v = static_cast<std::size_t>(mesh.triangles[c / 3][c % 3]);
    const std::int32_t fan = fans.find(static_cast<std::int32_t>(c));
    if (fan_of[v] < 0) fan_of[v] = fan;
    if (fan_of[v] != fan) touching[v] = true;
  }
  for (std::size_t v = 0; v < touching.size(); ++v) {
    if (touching[v]) topology.touching.add(static_cast<std::int32_t>(v));
  }
}

void countLoops(const std::vector<HalfEdge>& half_edges, std::size_t vertices, MeshTopology& topology) {
  if (topology.boundary.count == 0) return;
  UnionFind loops(vertices);
  forEachEdge(half_edges, [&](auto edge) {
    if (isBoundary(edge)) loops.join(edge[0].low, edge[0].high);
  });
  std::vector<int> length(vertices);
  forEachEdge(half_edges, [&](auto edge) {
    if (isBoundary(edge)) ++length[static_cast<std::size_t>(loops.find(edge[0].low))];
  });
  for (std::size_t v = 0; v < vertices; ++v) {
    topology.loops += length[v] > 0;
    if (length[v] <= topology.longest_loop) continue;
    topology.longest_loop = length[v];
    topology.longest_loop_vertex = static_cast<std::int32_t>(v);
  }
}

void numberPieces(const TriangleMesh& mesh, UnionFind& pieces, MeshTopology& topology) {
  for (std::size_t t = 0; t < topology.piece_of.size(); ++t) {
    if (namesAVertexTwice(mesh.triangles[t])) continue;
    const std::int32_t first = pieces.find(static_cast<std::int32_t>(t));
    const bool is_first = first == static_cast<std::int32_t>(t);
    topology.piece_of[t] = is_first ? topology.pieces++ : topology.piece_of[static_cast<std::size_t>(first)];
  }
}

}  // namespace

void joinFans(std::span<const HalfEdge> edge, UnionFind& fans) {
  for (std::size_t k = 1; k < edge.size(); ++k) {
    const HalfEdge &a = edge[0], &b = edge[k];
    const std::int32_t a_from = 3 * a.triangle + a.side, a_to = 3 * a.triangle + (a.side + 1) % 3;
    const std::int32_t b_from = 3 * b.triangle + b.side, b_to = 3 * b.triangle + (b.side + 1) % 3;
    const bool same_way = a.forward == b.forward;
    fans.join(a_from, same_way ? b_from : b_to);
    fans.join(a_to, same_way ? b_to : b_from);
  }
}

MeshTopology findTopology(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges) {
  MeshTopology topology;
  UnionFind pieces(mesh.triangles.size()), fans(3 * mesh.triangles.size());
  forEachEdge(half_edges, [&](auto edge) {
    ++topology.edges;
    if (isBoundary(edge)) topology.boundary.add(endsOf(edge));
    if (isBranching(edge)) topology.branching.add(endsOf(edge));
    if (isReversed(edge)) topology.reversed.add(endsOf(edge));
    joinFans(edge, fans);
    for (const HalfEdge& h : edge) pieces.join(edge[0].triangle, h.triangle);
  });
  PINCER_ASSERT(half_edges.size() <= 3 * mesh.triangles.size());
  topology.piece_of.assign(mesh.triangles.size(), -1);
  numberPieces(mesh, pieces, topology);
  countTouchingVertices(mesh, fans, topology);
  countLoops(half_edges, mesh.vertices.size(), topology);
  return topology;
}

// They meet at the edge between the two lowest of their vertices.
std::vector<std::vector<std::int32_t>> equalTriangles(const TriangleMesh& mesh,
                                                      const std::vector<HalfEdge>& half_edges) {
  std::vector<std::vector<std::int32_t>> groups;
  std::vector<std::array<std::int32_t, 2>> tops;  // third vertex, triangle
  forEachEdge(half_edges, [&](auto edge) {
    if (edge.size() < 2) return;
    tops.clear();
    for (const HalfEdge& h : edge) {
      const std::int32_t top =
          mesh.triangles[static_cast<std::size_t>(h.triangle)][static_cast<std::size_t>((h.side + 2) % 3)];
      if (top > h.high) tops.push_back({top, h.triangle});
    }
    std::sort(tops.begin(), tops.end());
    for (std::size_t i = 1; i < tops.size(); ++i) {
      if (tops[i][0] != tops[i - 1][0]) continue;
      if (i == 1 || tops[i - 1][0] != tops[i - 2][0]) groups.push_back({tops[i - 1][1]});
      groups.back().push_back(tops[i][1]);
    }
  });
  return groups;
}

std::vector<bool> usedVertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    for (const std::int32_t v : t) used[static_cast<std::size_t>(v)] = true;
  }
  return used;
}

std::vector<std::int32_t> firstAtSamePlace(const TriangleMesh& mesh, const std::vector<bool>& candidate) {
  PINCER_ASSERT(candidate.size() == mesh.vertices.size());
  struct Key {
    double x, y, z;
    std::int32_t vertex;
    bool samePlace(const Key& o) const { return x == o.x && y == o.y && z == o.z; }
    bool operator<(const Key& o) const {
      return x != o.x ? x < o.x : y != o.y ? y < o.y : z != o.z ? z < o.z : vertex < o.vertex;
    }
  };
  std::vector<Key> keys;
  for (std::size_t i = 0; i < candidate.size(); ++i) {
    const Vec3& p = mesh.vertices[i];
    if (candidate[i]) keys.push_back({p.x(), p.y(), p.z(), static_cast<std::int32_t>(i)});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> first(candidate.size());
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (keys[i].samePlace(keys[i - 1]))
      first[static_cast<std::size_t>(keys[i].vertex)] = first[static_cast<std::size_t>(keys[i - 1].vertex)];
  }
  return first;
}

Vec3 areaVector(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t) {
  const auto p = [&](std::size_t i) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[i])]; };
  return 0.5 * (p(1) - p(0)).cross(p(2) - p(0));
}

}  // namespace pincer::contact
