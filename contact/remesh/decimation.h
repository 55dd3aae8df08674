// decimation: a mesh that loses one vertex after the other, the one that changes its shape least first.
//
//   cost of moving vertex 0 onto its neighbour 1 = p_1^T Q_0 p_1
//   Q_0 = sum over planes of A (n, -n.q)(n, -n.q)^T   [m^4]
//
//   planes  of the facets that were around vertex 0 and around all that has moved onto it; n unit
//           normal, q a point of it, A its area [m^2]
// No vertex moves elsewhere, so that all lie on the shape; each keeps its shading normal, or several on a crease. A
// vertex on a crease or a border moves along it only; where creases meet, end or turn sharply it stays. A move isn't
// made that would turn a facet by more than 60 degrees, lean its corners' normals from it by more than 72 degrees, make
// a needle of it, or lead the smooth surface further than is allowed from a vertex that has gone: each facet knows
// those that were over it, up to eight that it fits worst. Source: M. Garland, P. Heckbert, "Surface simplification
// using quadric error metrics", SIGGRAPH 1997. Departures: half-edge collapses; the error that is allowed is the smooth
// surface's, to which a facet's corners and their normals lead, not the facet's.
#pragma once
#include <memory>

#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

class Decimation {
 public:
  // Requires a well-formed, manifold mesh, and 0 < crease_angle <= pi [rad]. `stays`: vertices that may not move, by
  // their indices; empty: any may.
  Decimation(const TriangleMesh& mesh, double crease_angle, bool use_file_normals, const std::vector<bool>& stays);
  ~Decimation();

  int triangles() const;
  // Removes vertices until at most `triangles` are left, or none can be removed. `error`: that is allowed [m], > 0;
  // kInfinity for any. Called again, it goes on; an error that is larger then allows more.
  void reduceTo(int triangles, double error);
  // The mesh as it is now: vertices in the input's order, a normal at each corner, no smoothing groups.
  TriangleMesh mesh() const;

 private:
  class Data;
  std::unique_ptr<Data> data_;
};

}  // namespace pincer::contact
