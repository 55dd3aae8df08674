// smooth_mesh: a triangle mesh felt as the smooth surface it stands for, touched by a spherical fingertip.
//
//   p_BC = S(u, v) + h N(u, v),   phi = h - r
//
//   S  cubic patch over each triangle [m], N  its quadratic shading normal, both continuous across smooth edges to
//      round-off; frame B
//   p_BC  fingertip centre, h  its signed height over the surface [m], r  fingertip radius [m]
//   phi   gap [m], negative when they overlap
// On a convex crease no surface point fulfils the equation: there the contact is the point of the edge curve (or the
// vertex) and the normal points from it to the fingertip's centre.
//
// Source: A. J. Doxon, D. E. Johnson, H. Z. Tan, W. R. Provancher, Presence 20(6), 2011 (the fixed point); A. Vlachos
// et al., "Curved PN triangles", 2001 (patch). Departures: edge cubics after D. Walton, D. Meek, Computer-Aided Design
// 28(2), 1996, so that an edge depends on its own ends only; Bernstein normals with the factor 2 on mixed terms;
// Newton's method in place of the published iteration.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pincer/contact/math.h"
#include "pincer/contact/surface_contact.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

class MeshFeatures;  // contact/surface/mesh_features.h
class SurfaceNet;    // contact/surface/surface_net.h
struct Patch;        // contact/surface/patch.h

struct SurfaceOptions {
  // [rad], 40 degrees; in (0, pi]: edges with a sharper angle between facets stay sharp
  double crease_angle = 0.6981317007977318;
  // where the file has normals they decide what is sharp; false: the crease angle decides
  bool use_file_normals = true;
  SurfaceVariant variant = SurfaceVariant::smooth;  // flat_contact.h, published_iteration.h
  std::function<void(double)> progress = {};        // told the share of the work that is done, 0 to 1, now and then
};

class SmoothMesh {
 public:
  // Builds neighbours, normals, search tree and convex hull; no patch. The mesh must be well-formed and manifold
  // (mesh_report.h); an open border is felt as a sharp edge. Normals of the file that point to the back of their
  // triangle don't count. Throws InputError.
  static std::shared_ptr<const SmoothMesh> build(TriangleMesh mesh, const SurfaceOptions& options = {});
  ~SmoothMesh();
  SmoothMesh(const SmoothMesh&) = delete;
  SmoothMesh& operator=(const SmoothMesh&) = delete;

  // Contacts of a sphere of radius `r` > 0 [m] centred at the finite `p_BC`: the main one, whatever its gap, and up to
  // two further ones with phi < `margin` [m], >= 0. While the finger overlaps the surface the contacts that `tracker`
  // follows are kept (the far side of a thin wall never takes over); in free space the closest one wins
  // (surface/lookout.h). The result fulfils the equation above to 1e-8 of the mesh's size. Allocates nothing, throws
  // nothing; several threads may query one mesh, each with its own cache.
  SurfaceContacts querySphere(const Vec3& p_BC, double r, double margin, SurfaceTracker& tracker,
                              PatchCache& cache) const;

  const std::vector<Vec3>& hullVertices() const;  // corners of the mesh's convex hull, each a vertex of the mesh [m]
  double boundingRadius() const;                  // of a sphere about B's origin that holds the surface [m]
  const TriangleMesh& triangles() const;          // without the file's normals
  Patch patch(std::int32_t triangle) const;       // the surface over it, to be drawn or exported; built at every call
  std::size_t memoryBytes() const;                // of all that is kept of it

  SurfaceVariant variant() const;
  const MeshFeatures& features()
      const;  // of the flat triangles, for other bodies; built (and memory taken) by the first call, from any thread

  const SurfaceNet& net() const;  // the patches and how they hang together
  double bulge() const;           // how far the smooth surface is from the flat triangles, at most [m]; 0: it is them

  // whose patch folds over: contact there may be held (kQueryHeldDirection)
  const std::vector<std::int32_t>& foldedTriangles() const;
  double tightestConcaveRadius() const;  // of the surface [m]; infinity where it is convex
  // Shortcomings that a finger of radius `r` [m] will feel, one sentence each with
  // remedy; complements inspect() (mesh_report.h).
  std::vector<std::string> findings(double r) const;

 private:
  struct Data;
  explicit SmoothMesh(std::unique_ptr<const Data> data);
  std::unique_ptr<const Data> data_;
};

}  // namespace pincer::contact
