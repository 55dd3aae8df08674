// surface_net: the patches of a mesh and how they hang together.
//
// Kept are the mesh, its neighbours and its corner normals, about 60 bytes per triangle, 12 more where some normals
// outweigh others (mesh/edge_weights.h); a patch is built from them
// when it is first touched. Of the shading variants
//   smooth            has cubic edges that both sides share (edge_cubic.h), and a centre by its medians, of the same
//                     cubics:  b_111 = (27 m - sum of corners - 3 sum of handles) / 6,
//                     m  mean of the medians' places after 2/3 of their way [m];
//                     where an edge's ends weigh w : 1, its middle normal is n_110 + ((w - 1) n0 + (1/w - 1) n1) / 2,
//                     so that N ~ (1 - s) w n0 + s n1, and its bend, as a median's, is 4 w / (1 + w)^2 of an even one's
//   smooth_published  each side's own, V = P + (d - (d.N) N) / 3, d to the other end,
//                     b_111 = E + (E - V) / 2 of the handles' mean E and the corners' V (Vlachos et al., eq. 3)
//   facet and force   have flat triangles with their own normals, which aren't kept; `force` keeps the corner normals
//                     beside.
#pragma once
#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "pincer/contact/assert.h"
#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/mesh/edge_weights.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/contact/surface/surface_cell.h"
#include "pincer/contact/surface_contact.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct CellCorner {
  std::int32_t triangle;
  std::int32_t corner;
};

class SurfaceNet {
 public:
  // Requires a manifold mesh. The file's normals are dropped from it once the corner normals are known.
  SurfaceNet(TriangleMesh mesh, double crease_angle, bool use_file_normals,
             SurfaceVariant variant = SurfaceVariant::smooth);

  int size() const { return static_cast<int>(mesh_.triangles.size()); }  // triangles
  const TriangleMesh& mesh() const { return mesh_; }
  // half the diagonal of the box around the vertices [m]: what small and large are measured by
  double length() const { return length_; }
  std::size_t memoryBytes() const;
  std::uint64_t fingerprint() const { return fingerprint_; }

  // Valid until the next call with the same cache: copy what is to be kept.
  const SurfaceCell& cell(std::int32_t triangle, PatchCache& cache) const {
    PatchCache::Place& place = cache.placeOf(fingerprint_, triangle);
    if (place.triangle != triangle || place.net != fingerprint_) fill(triangle, place);
    return place.cell;
  }
  SurfaceCell build(std::int32_t triangle) const {
    SurfaceCell cell;
    build(triangle, cell);
    return cell;
  }

  const Vec3& vertex(std::int32_t triangle, int corner) const {
    return mesh_.vertices[at(mesh_.triangles[at(triangle)][at(corner)])];
  }
  // The patch's.
  Vec3 normal(std::int32_t triangle, int corner) const {
    return is_flat_ ? facetNormal(triangle) : shadingNormal(triangle, corner);
  }
  Vec3 facetNormal(std::int32_t triangle) const;  // unit; zero for a triangle without area
  // Not of a `facet`.
  const Vec3& shadingNormal(std::int32_t triangle, int corner) const {
    PINCER_ASSERT(variant_ != SurfaceVariant::facet);
    return normals_[at(links_[at(triangle)].normals[at(corner)])];
  }
  Neighbour neighbour(std::int32_t triangle, int edge) const {
    PINCER_ASSERT(0 <= triangle && triangle < size() && 0 <= edge && edge < 3);
    const std::int32_t code = links_[at(triangle)].across[at(edge)];
    return code < 0 ? Neighbour{} : Neighbour{code / 8, static_cast<std::int8_t>(code % 4)};
  }
  bool isSharp(std::int32_t triangle, int edge) const {
    const std::int32_t code = links_[at(triangle)].across[at(edge)];
    return code < 0 || (code & 4) != 0;
  }

  // Calls visit(CellCorner) on all triangles around the vertex at `start`, once each, from `start` on clockwise
  // (at a border then on its other side), until visit returns false if it returns bool. Returns whether the
  // vertex is on a border (as far as it came).
  template <class Visit>
  bool visitCorners(const CellCorner& start, Visit&& visit) const;

 private:
  static std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

  SurfaceVariant variant_;
  bool is_flat_;  // facet or force
  TriangleMesh mesh_;
  // kept out of what finds a patch in its place
  [[gnu::noinline]] void fill(std::int32_t triangle, PatchCache::Place& place) const;
  void build(std::int32_t triangle, SurfaceCell& cell) const;
  bool haveOtherNormals(std::int32_t triangle, int edge) const;
  // Asks memory for the numbers of the triangles around one. Always inlined: to the compiler it is
  // without effect, and it drops calls of such.
  [[gnu::always_inline]] void fetchAround(std::int32_t triangle) const;

  // Neighbours across a triangle's edges and corners, side by side in memory, for they are asked for together.
  struct Links {
    std::array<std::int32_t, 3> across;   // 8 triangle + 4 if sharp + edge, -1 at a border
    std::array<std::int32_t, 3> normals;  // places in normals_
  };
  std::vector<Links> links_;
  std::vector<Vec3> normals_;  // those that differ; a fan shares one
  EdgeWeights weights_;        // of `smooth` only
  std::uint64_t fingerprint_ = 0;
  double length_ = 0;
};

template <class Visit>
bool SurfaceNet::visitCorners(const CellCorner& start, Visit&& visit) const {
  const auto goesOn = [&](const CellCorner& c) {
    if constexpr (std::is_same_v<decltype(visit(c)), bool>) return visit(c);
    visit(c);
    return true;
  };
  CellCorner at_corner = start;
  do {
    if (!goesOn(at_corner)) return false;
    const Neighbour other = neighbour(at_corner.triangle, (at_corner.corner + 2) % 3);
    at_corner = {other.triangle, other.edge};
  } while (at_corner.triangle >= 0 && at_corner.triangle != start.triangle);
  if (at_corner.triangle >= 0) return false;
  for (at_corner = start;;) {
    const Neighbour other = neighbour(at_corner.triangle, at_corner.corner);
    if (other.triangle < 0) return true;
    at_corner = {other.triangle, (other.edge + 1) % 3};
    if (!goesOn(at_corner)) return true;
  }
}

// Curvature along an edge of a patch [1/m], positive where concave, at the lighter end if one outweighs the other:
//   kappa = -w (n1 - n0) . (p1 - p0) / |p1 - p0|^2
double concaveCurvature(const Patch& patch, int edge);

// Figures of a surface from one look at every patch.
struct NetFindings {
  std::vector<std::int32_t>
      folded;  // triangles with (Su x Sv) . N <= 0 somewhere on a grid of 28 points: contact there may be held or jump
  // Smallest radius of concave curvature along an edge [m], infinity for a convex surface: a
  // finger of a larger radius doesn't fit there.
  double concave_radius;
  double bounding_radius;  // of a sphere about B's origin that holds the surface [m]
};
class NetInspector {
 public:
  void see(std::int32_t triangle, const Patch& patch);
  NetFindings findings() const;

 private:
  std::vector<std::int32_t> folded_;
  double sharpest_ = 0, radius2_ = 0;
};

}  // namespace pincer::contact
