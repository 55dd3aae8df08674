// round_edges: a mesh whose sharp edges are rounded by a ball of radius rho that rolls
// along them, as extra triangles with normals.
//
//   ball at vertex p:  n_i . (c - p) = -s rho  for the normals n_i of all faces that meet there
//                      face i moves to  c + s rho n_i
//   two faces:         c = p - s rho (nA + nB) / (1 + nA . nB)
//   tip of a cone of half angle alpha about a:  c = p - s rho a / sin(alpha)
//
//   rho  radius [m];  s = +1 where the edges are convex, -1 where they are concave;  c  the ball's centre [m], frame B
// A crease becomes a strip of an arc that is tangent to both faces, a corner a patch of the ball, the tip of a cone a
// cap. Each vertex of the result has one normal, the ball's or its face's, so that the smooth surface is
// tangent-continuous everywhere. Where a crease fades out, its strip narrows to a point.
// A finger loses contact at the edges of a cube, and a person takes that for a hole; 1.5 mm mend it. Source: A. J.
// Doxon, doctoral text, University of Utah, 2014, ch. 2. The exact shape is the solid's opening by the ball (J. Serra,
// Image Analysis and Mathematical Morphology, 1982) where all edges are convex.
// Departures: a face that is curved across its edge is met on its tangent plane, kappa (rho tan(theta /
// 2))^2 / 2 off, theta the turn over the edge. Parts that aren't neighbours may come to overlap where
// concave edges are rounded; that isn't checked.
#pragma once
#include "pincer/contact/error.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

struct RoundOptions {
  double radius = 1.5e-3;                    // rho [m], > 0
  double crease_angle = 0.6981317007977318;  // [rad], in (0, pi]: edges with a sharper angle between facets are creases
  bool use_file_normals = true;              // where the file has normals they decide what is sharp
  int segments = 4;                          // of an arc of 90 degrees, 1 .. 64
};

struct RoundedMesh {
  TriangleMesh mesh;  // the input itself where nothing was sharp
  int creases = 0;    // edges rounded
  int corners = 0;    // places where three or more creases met
  int tips = 0;       // of cones
};

// The mesh must be closed (requireClosed, mesh_report.h). Throws InputError where the faces are too small for the
// radius (with the largest that fits) and at corners that no ball touches on all sides: convex and concave edges
// together, or four and more faces at random.
RoundedMesh roundEdges(const TriangleMesh& mesh, const RoundOptions& options = {});

}  // namespace pincer::contact
