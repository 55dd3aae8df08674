// half_edges: the edges of any validated triangle mesh, also of one that branches or is open, as runs of a sorted list.
//
// Half-edge i of a triangle goes from its corner i to corner (i + 1) mod 3. All half-edges between the same two vertices form one edge.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/mesh/triangle_mesh.h"

namespace pincer::contact {

struct HalfEdge {
  std::int32_t low, high;  // vertices, low < high
  std::int32_t triangle;
  std::int8_t side;  // 0, 1, 2: which of the triangle's half-edges
  bool forward;      // from low to high
};

// All half-edges, sorted by (low, high, triangle, side): half-edges of one edge are neighbours in the list.
std::vector<HalfEdge> sortedHalfEdges(std::span<const std::array<std::int32_t, 3>> triangles);

// The edge that begins at `first` in the sorted list.
std::span<const HalfEdge> edgeAt(std::span<const HalfEdge> half_edges, std::size_t first);

// Whether the surface is manifold at this edge, and whether it ends there.
inline bool isBoundary(std::span<const HalfEdge> edge) { return edge.size() == 1; }
inline bool isRegular(std::span<const HalfEdge> edge) { return edge.size() == 2 && edge[0].forward != edge[1].forward; }

}  // namespace pincer::contact
