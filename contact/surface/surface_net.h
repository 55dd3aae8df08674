// surface_net: the patches of a mesh and how they hang together.
//
// What is kept is the mesh, its neighbours and its corner normals; a patch is built from them when it is first touched.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contact/mesh/connectivity.h"
#include "contact/mesh/triangle_mesh.h"
#include "contact/surface/patch_cache.h"
#include "contact/surface/surface_cell.h"

namespace pincer::contact {

struct CellCorner {
  std::int32_t triangle;
  std::int32_t corner;
};

class SurfaceNet {
 public:
  // Requires a manifold mesh.
  SurfaceNet(TriangleMesh mesh, double crease_angle, bool use_file_normals);

  int size() const { return static_cast<int>(mesh_.triangles.size()); }  // triangles
  const TriangleMesh& mesh() const { return mesh_; }
  const Neighbours& neighbours() const { return neighbours_; }

  // Valid until the next call with the same cache: copy what is to be kept.
  const SurfaceCell& cell(std::int32_t triangle, PatchCache& cache) const {
    PatchCache::Place& place = cache.placeOf(fingerprint_, triangle);
    if (place.triangle != triangle || place.net != fingerprint_) place = {fingerprint_, triangle, build(triangle)};
    return place.cell;
  }
  SurfaceCell build(std::int32_t triangle) const;

  // The triangles around a vertex of the mesh, in increasing order.
  std::span<const CellCorner> cornersAt(std::int32_t vertex) const;

 private:
  TriangleMesh mesh_;
  Neighbours neighbours_;
  CornerNormals corner_normals_;
  std::uint64_t fingerprint_;
  std::vector<CellCorner> corners_;        // grouped by vertex
  std::vector<std::size_t> first_corner_;  // per vertex, and one behind the last
};

// Triangles whose patch folds over: (Su x Sv) . N <= 0 somewhere on a grid of 28 points. Contact there may be held or jump.
std::vector<std::int32_t> findFoldedTriangles(const SurfaceNet& net);

// Smallest radius of concave curvature along an edge [m], infinity for a convex surface: a finger of a larger radius doesn't fit there.
//   kappa = (n1 - n0) . (p1 - p0) / |p1 - p0|^2,  concave where negative
double findTightestConcaveRadius(const SurfaceNet& net);

}  // namespace pincer::contact
