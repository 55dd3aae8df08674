// mesh_features: the flat triangles of a mesh with their corners and edges, for contact with other bodies (contact/shape/mesh_pairs.h).
//
// Each vertex and each edge belongs to one triangle, the first that has it, so that a walk over triangles meets it once. An edge counts
// where the surface is convex across it: no other can touch a body that its two triangles don't touch.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "contact/mesh/connectivity.h"
#include "contact/mesh/triangle_mesh.h"
#include "contact/surface/aabb_tree.h"

namespace pincer::contact {

class MeshFeatures {
 public:
  MeshFeatures(const TriangleMesh& mesh, const Neighbours& neighbours);

  struct Triangle {
    std::array<Vec3, 3> p;                 // [m]
    Vec3 n;                                // unit normal, out of the solid
    std::array<std::int32_t, 3> vertices;  // of the mesh
    std::uint8_t owned;          // bit i: corner i belongs to it; bit 3 + i: edge i, from corner i to (i + 1) mod 3, and is convex
    std::array<Vec3, 3> beyond;  // per owned edge: the third corner of the triangle on its other side [m]

    bool ownsCorner(int i) const { return owned >> i & 1; }
    bool ownsEdge(int i) const { return owned >> (3 + i) & 1; }
  };
  Triangle triangle(const TriangleMesh& mesh, std::int32_t t) const;

  std::size_t memoryBytes() const { return owned_.capacity() + opposite_.capacity() * sizeof(opposite_[0]) + tree_.memoryBytes(); }

  // Calls visit(t) on every triangle whose box meets [low, high]; at most `most` of them. Allocates nothing.
  template <class Visit>
  void visitBox(const Vec3& low, const Vec3& high, int most, Visit&& visit) const {
    tree_.visitBox(low, high, most, [&](std::int32_t place) { visit(tree_.order()[static_cast<std::size_t>(place)]); });
  }

 private:
  std::vector<std::uint8_t> owned_;                    // per triangle
  std::vector<std::array<std::int32_t, 3>> opposite_;  // per triangle and edge: the vertex beyond it, -1 at a border
  AabbTree tree_;
};

}  // namespace pincer::contact
