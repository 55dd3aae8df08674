// surface_net: the patches of a mesh and how they hang together. Built once, then constant.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/mesh/connectivity.h"
#include "contact/mesh/triangle_mesh.h"
#include "contact/surface/patch.h"

namespace pincer::contact {

// One triangle as the solver sees it.
struct SurfaceCell {
  Patch patch;
  std::array<Neighbour, 3> neighbours;   // across edge i, from corner i to (i + 1) mod 3
  std::array<std::int32_t, 3> vertices;  // of the mesh
  std::array<bool, 3> sharp;             // edge i has different normals on its two sides, or only one side
};

struct CellCorner {
  std::int32_t triangle;
  std::int32_t corner;
};

class SurfaceNet {
 public:
  // Requires a manifold mesh.
  SurfaceNet(const TriangleMesh& mesh, double crease_angle, bool use_file_normals);

  const SurfaceCell& cell(std::int32_t triangle) const { return cells_[static_cast<std::size_t>(triangle)]; }
  const std::vector<SurfaceCell>& cells() const { return cells_; }
  // The triangles around a vertex of the mesh, in increasing order.
  std::span<const CellCorner> cornersAt(std::int32_t vertex) const;

 private:
  std::vector<SurfaceCell> cells_;
  std::vector<CellCorner> corners_;        // grouped by vertex
  std::vector<std::size_t> first_corner_;  // per vertex, and one behind the last
};

// Triangles whose patch folds over: (Su x Sv) . N <= 0 somewhere on a grid of 28 points. Contact there may be held or jump.
std::vector<std::int32_t> findFoldedTriangles(const SurfaceNet& net);

// Smallest radius of concave curvature along an edge [m], infinity for a convex surface: a finger of a larger radius doesn't fit there.
//   kappa = (n1 - n0) . (p1 - p0) / |p1 - p0|^2,  concave where negative
double findTightestConcaveRadius(const SurfaceNet& net);

}  // namespace pincer::contact
