// half_edges: the edges of any validated triangle mesh, also of one that branches or is open, as runs of a sorted list.
//
// Half-edge i of a triangle goes from its corner i to corner (i + 1) mod 3. All half-edges between
// the same two vertices form one edge. A triangle that names a vertex twice (ReadOptions can keep
// such) has no edges here: nothing hangs on it.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct HalfEdge {
  std::int32_t low, high;  // vertices, low < high
  std::int32_t triangle;
  std::int8_t side;  // 0, 1, 2: which of the triangle's half-edges
  bool forward;      // from low to high
};

inline bool namesAVertexTwice(const std::array<std::int32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// All half-edges, sorted by (low, high, triangle, side): half-edges of one edge are neighbours in the list. Time:
// linear in the number of triangles while no vertex is in very many.
std::vector<HalfEdge> sortedHalfEdges(std::span<const std::array<std::int32_t, 3>> triangles);

// The edge that begins at `first` in the sorted list.
std::span<const HalfEdge> edgeAt(std::span<const HalfEdge> half_edges, std::size_t first);

// Calls visit(edge) on every edge of the sorted list, in order.
template <class Visit>
void forEachEdge(std::span<const HalfEdge> half_edges, Visit&& visit) {
  for (std::size_t i = 0; i < half_edges.size();) {
    const auto edge = edgeAt(half_edges, i);
    visit(edge);
    i += edge.size();
  }
}

// State of an edge: the surface ends there, branches, has two triangles that
// face opposite ways, or goes on as it should.
inline bool isBoundary(std::span<const HalfEdge> edge) { return edge.size() == 1; }
inline bool isBranching(std::span<const HalfEdge> edge) { return edge.size() > 2; }
inline bool isReversed(std::span<const HalfEdge> edge) {
  return edge.size() == 2 && edge[0].forward == edge[1].forward;
}
inline bool isRegular(std::span<const HalfEdge> edge) { return edge.size() == 2 && edge[0].forward != edge[1].forward; }

// The vertices a half-edge runs from and to.
inline std::int32_t fromVertex(const HalfEdge& h) { return h.forward ? h.low : h.high; }
inline std::int32_t toVertex(const HalfEdge& h) { return h.forward ? h.high : h.low; }

}  // namespace pincer::contact
