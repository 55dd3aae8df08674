// mesh_topology: how the triangles of any validated mesh hang together, also where they
// branch, end, touch or face opposite ways.
//
//   piece  triangles joined by edges;  loop  open edges joined by vertices: the rim of a hole, or of a sheet
//   fan    corners around a vertex joined across edges; a vertex with several
//          fans is one where the surface touches itself
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/mesh/half_edges.h"
#include "pincer/contact/mesh/union_find.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

using VertexPair = std::array<std::int32_t, 2>;

// Where `count` of something are, by the first one.
template <class Place>
struct Occurrences {
  int count = 0;
  Place first{};
  void add(const Place& place) {
    if (count++ == 0) first = place;
  }
};

struct MeshTopology {
  int edges = 0;
  Occurrences<VertexPair> boundary;    // edges with one triangle
  Occurrences<VertexPair> branching;   // with more than two
  Occurrences<VertexPair> reversed;    // with two that run the same way: one of them is flipped
  Occurrences<std::int32_t> touching;  // vertices with several fans
  int loops = 0;
  int longest_loop = 0;  // edges of the loop that has most
  std::int32_t longest_loop_vertex = -1;
  // per triangle; numbered in the order of their first triangles; -1 for triangles without edges
  std::vector<std::int32_t> piece_of;
  int pieces = 0;
};

MeshTopology findTopology(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges);

// Corners 3 t + i that meet across `edge` become members of one fan.
void joinFans(std::span<const HalfEdge> edge, UnionFind& fans);

// Triangles that have the same vertices, whichever way they face: groups of at least two, each in increasing order.
std::vector<std::vector<std::int32_t>> equalTriangles(const TriangleMesh& mesh,
                                                      const std::vector<HalfEdge>& half_edges);

// For each vertex the first one at exactly its place, among those that `candidate`
// marks; other vertices stand for themselves.
std::vector<std::int32_t> firstAtSamePlace(const TriangleMesh& mesh, const std::vector<bool>& candidate);

// Vertices that a triangle names.
std::vector<bool> usedVertices(const TriangleMesh& mesh);

// Half the cross product of two sides: the triangle's area along its normal [m^2].
Vec3 areaVector(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& triangle);

}  // namespace pincer::contact
