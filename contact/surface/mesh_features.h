// mesh_features: the flat triangles of a mesh with their corners and edges, for contact with other bodies
// (contact/shape/mesh_pairs.h, mesh_mesh.h).
//
// Each vertex and each edge belongs to one triangle, the first that has it, so that a walk over triangles meets it
// once. An edge counts where the surface is convex across it, a vertex where such an edge or a border ends or bends in
// it: no others can touch a body that the triangles and edges around them don't touch, and how a flat face and its rim
// are cut makes no difference. The signed distance of a point is that to the nearest triangle, negative where it lies
// behind the surface there: behind the face, or where an edge or vertex is nearest, against the sum of the normals
// around it, each weighted by its angle. Source: J. A. Baerentzen, H. Aanaes, IEEE Trans. Visualization Comput.
// Graphics 11(3), 2005 (those normals decide inside and outside exactly); nearest point of a triangle: C. Ericson,
// Real-Time Collision Detection (2005), sec. 5.1.5.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/surface/aabb_tree.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

class MeshFeatures {
 public:
  // `mesh` must outlive this.
  MeshFeatures(const TriangleMesh& mesh, const Neighbours& neighbours);

  struct Triangle {
    std::array<Vec3, 3> p;                 // [m]
    Vec3 n;                                // unit normal, out of the solid
    std::array<std::int32_t, 3> vertices;  // of the mesh
    // bit i: corner i belongs to it and counts; bit 3 + i: edge i, from corner i to (i + 1) mod 3, likewise
    std::uint8_t owned;
    std::array<Vec3, 3> beyond;  // per owned edge: the third corner of the triangle on its other side [m]

    bool ownsCorner(int i) const { return owned >> i & 1; }
    bool ownsEdge(int i) const { return owned >> (3 + i) & 1; }
    const Vec3& corner(int i) const { return p[static_cast<std::size_t>(i % 3)]; }
    std::int32_t vertex(int i) const { return vertices[static_cast<std::size_t>(i % 3)]; }
    // True if `q` lies over the triangle, or beside it by less than `slack` [m].
    bool isUnder(const Vec3& q, double slack) const;
  };
  Triangle triangle(std::int32_t t) const;
  bool meetsBox(std::int32_t t, const Vec3& low, const Vec3& high) const {  // the triangle's own box
    const auto& v = cornersOf(t);
    const Vec3 &a = vertex(v[0]), &b = vertex(v[1]), &c = vertex(v[2]);
    return (a.cwiseMax(b).cwiseMax(c) - low).minCoeff() >= 0 && (high - a.cwiseMin(b).cwiseMin(c)).minCoeff() >= 0;
  }

  struct Nearest {
    Vec3 p = Vec3::Zero();  // of the surface [m]
    Vec3 n = Vec3::Zero();  // unit, out of the solid: from p to the point where that is outside, else the other way
    double distance = 0;    // signed [m]
    bool found = false;
  };
  // The nearest point of the surface to `q` that is nearer than `bound` > 0 [m]. Allocates nothing.
  Nearest nearest(const Vec3& q, double bound) const;

  // True if the surface around the vertex lies above the plane through it across the unit vector `n`, but for
  // directions that fall by less than `slack` (sine).
  bool liesAbove(std::int32_t vertex, const Vec3& n, double slack) const;

  const AabbTree& tree() const { return tree_; }
  // Of the triangles that own a corner or edge only: on a finely cut flat face there
  // is none, and a walk over it costs nothing.
  const AabbTree& owners() const { return owners_; }
  std::size_t memoryBytes() const;

  // Calls visit(t) on every triangle whose leaf's box meets [low, high]. Allocates nothing.
  template <class Visit>
  void visitBox(const Vec3& low, const Vec3& high, Visit&& visit) const {
    tree_.visitBox(low, high, std::numeric_limits<int>::max(),
                   [&](std::int32_t place) { visit(tree_.order()[static_cast<std::size_t>(place)]); });
  }
  // The same on those that own a corner or edge.
  template <class Visit>
  void visitOwners(const Vec3& low, const Vec3& high, Visit&& visit) const {
    owners_.visitBox(low, high, std::numeric_limits<int>::max(), [&](std::int32_t place) {
      visit(owner_numbers_[static_cast<std::size_t>(owners_.order()[static_cast<std::size_t>(place)])]);
    });
  }

 private:
  const Vec3& vertex(std::int32_t v) const { return mesh_->vertices[static_cast<std::size_t>(v)]; }
  const std::array<std::int32_t, 3>& cornersOf(std::int32_t t) const {
    return mesh_->triangles[static_cast<std::size_t>(t)];
  }
  std::span<const std::int32_t> trianglesAt(std::int32_t v) const;
  std::vector<std::int32_t> findOwners(const Neighbours& neighbours);
  void setOwners(const Neighbours& neighbours);
  void setTrianglesAtVertices();
  Vec3 normalAround(std::int32_t v) const;
  Vec3 normalAcross(std::int32_t t, int edge) const;

  const TriangleMesh* mesh_;
  std::vector<std::uint8_t> owned_;                    // per triangle
  std::vector<std::array<std::int32_t, 3>> opposite_;  // per triangle and edge: the vertex beyond it, -1 at a border
  std::vector<std::int32_t> first_at_vertex_, triangles_at_vertex_;
  AabbTree tree_;
  std::vector<std::int32_t> owner_numbers_;  // triangles
  AabbTree owners_;
};

}  // namespace pincer::contact
