// edge_balls: where creases are, and the ball that touches all faces at each of their
// vertices (round_edges.h gives the equations).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/mesh/connectivity.h"
#include "pincer/contact/triangle_mesh.h"

namespace pincer::contact {

// Corners 3 t + i around a vertex, between two creases, by their first one.
using Fan = std::int32_t;

// A crease as seen from one of its ends: `triangle` lies to its left, `side` runs from this end to the other.
struct CreaseEnd {
  std::int32_t triangle;
  std::int8_t side;
  Fan left, right;
  bool convex;
};

// The ball of radius rho about p - s rho x touches every face i there, at p + s rho (n_i - x).
struct EdgeBall {
  std::vector<CreaseEnd> creases;  // that meet at the vertex
  Vec3 x = Vec3::Zero();           // [-]
  double s = 1;
  bool vanishes = false;  // a crease ends here, or both its sides have one normal: the strip narrows to a point
};

struct EdgeBalls {
  std::vector<Fan> fan_of;          // per corner
  std::vector<EdgeBall> at_vertex;  // without creases: nothing to round
  double widest_turn = 0;           // over a crease [rad]
};

// Requires a closed mesh. Throws InputError at corners that no ball touches on all sides.
EdgeBalls findEdgeBalls(const TriangleMesh& mesh, const Neighbours& neighbours, const CornerNormals& corners);

}  // namespace pincer::contact
