// simplify: a mesh of fewer triangles that feels the same, and one of more.
//
//   error = max over probes of |phi|
//   phi  gap between the probe and the smooth surface of the result [m] (smooth_mesh.h)
//   probe  a small ball that touches the input's smooth surface at one of its vertices, and nowhere else
//
// The smooth surfaces are compared, since these are what a finger feels: 320 triangles stand for a ball of 20 mm to 3
// um although their facets leave it by 400. Which vertices go first decimation.h says; creases and borders are kept. A
// finger's tick costs the same on few triangles and on many as long as they are in the cache; a mesh of 100,000 isn't.
#pragma once
#include "pincer/contact/error.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct SimplifyOptions {
  int triangles = 0;  // fewer than this aren't wanted, >= 0
  double error = 0;   // that is allowed [m], >= 0; 0: as many triangles as said above, whatever the error
  double crease_angle = 0.6981317007977318;  // [rad], in (0, pi]
  bool use_file_normals = true;              // where the file has normals they decide what is sharp
};

struct SimplifiedMesh {
  TriangleMesh mesh;   // its vertices are vertices of the input; with normals at all corners
  double error = 0;    // greatest [m]
  double typical = 0;  // root of the mean square [m]
};

// The mesh must be well-formed and manifold (mesh_report.h). Throws InputError for options out of range. The
// error that is allowed is kept to at all probes: where one misses, its vertex stays, or, where many do, less is
// allowed, and the whole is done again, eight times at most. Not kept to where the smooth surface folds over itself,
// for which no normals stand; the result says how large the error is in truth. Where no vertex can go, and neither
// options nor normals are needed to know what is sharp, the result is the input, without an error.
SimplifiedMesh simplify(const TriangleMesh& mesh, const SimplifyOptions& options);

// Each triangle as four, with new vertices in the middle of the smooth surface's edges and its
// normals at all corners. The same mesh must be given as to simplify. Throws InputError, also where
// it would have more than two million triangles.
TriangleMesh subdivide(const TriangleMesh& mesh, double crease_angle = 0.6981317007977318,
                       bool use_file_normals = true);

}  // namespace pincer::contact
