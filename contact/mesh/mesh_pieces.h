// mesh_pieces: the pieces of a mesh, which of them enclose a volume, which way they face, and which lie inside others.
//
//   V = sum over triangles of p0 . (p1 x p2) / 6  [m^3], negative when the triangles face inwards
//   w(p) = sum over triangles of Omega(p) / (4 pi);  |w| = 1 inside, 0 outside
//   Omega  the solid angle under which p sees the triangle
//
// A piece inside an odd number of others that faces inwards is a cavity, and sound. Source of Omega: A. van Oosterom,
// J. Strackee, IEEE Trans. Biomed. Eng. 30(2), 1983, eq. 8.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/contact/mesh/mesh_topology.h"

namespace pincer::contact {

struct MeshPiece {
  std::int32_t first_triangle = -1;
  int triangles = 0;
  Vec3 box_min, box_max;  // [m]
  double area = 0;        // [m^2]
  double volume = 0;      // signed [m^3]; meaningful for a closed piece only
  bool closed = true;     // every edge has two triangles, running opposite ways
  bool within = false;    // closed, and inside an odd number of other closed pieces

  bool facesInwards() const { return closed && !within && volume < 0; }
  bool hasNoThickness() const;  // closed, and flat to a ten-thousandth of its size
  bool isNestedSolid() const { return closed && within && volume > 0; }
};

struct MeshPieces {
  std::vector<MeshPiece> list;  // as MeshTopology::piece_of numbers them
  // false: there were too many pieces to find out which lie inside others; none counts as `within`
  bool nesting_known = true;
};

MeshPieces findPieces(const TriangleMesh& mesh, const std::vector<HalfEdge>& half_edges, const MeshTopology& topology);

}  // namespace pincer::contact
