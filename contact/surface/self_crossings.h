// self_crossings: where triangles of one mesh pass through each other.
//
// Two triangles cross if an edge of one goes through the inside of the other: its ends lie strictly on both sides of
// the triangle's plane, and the line strictly between its corners, by the signs of the volumes
//
//   V(a,b,c,d) = (b - a) . ((c - a) x (d - a)) / 6  [m^3],  each beyond round-off.
//
// So triangles that only touch, share an edge or lie in one plane don't cross; neighbours at a vertex may. Vertices at
// one place count as one. Source of the test: P. Guigue, O. Devillers, J. Graphics Tools 8(1), 2003 (the volumes'
// signs); of the candidates: boxes in a tree.
#pragma once
#include <cstdint>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

bool crossEachOther(const TriangleMesh& mesh, std::int32_t a, std::int32_t b);

struct SelfCrossings {
  std::int64_t pairs = 0;               // of triangles
  std::int32_t first = -1, other = -1;  // the first such triangle, and the first that it crosses
  bool is_all = true;                   // false: found too many candidates to look at all
};

// Time is bounded: it gives up looking after 200 candidates per triangle.
SelfCrossings findSelfCrossings(const TriangleMesh& mesh);

}  // namespace pincer::contact
