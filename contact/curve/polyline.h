// polyline: a path of straight segments in the plane, open or closed, with the body on its left: a closed one runs
// counter-clockwise around its body. The outward normal of a segment with unit direction e = (ex, ey) is n = (ey, -ex).
// A vertex that is named twice in a row is a sharp corner, as a mesh has one by several normals.
#pragma once
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::contact {

struct Polyline {
  std::vector<Vec2> vertices;  // [m]; a closed path doesn't come back to its first
  bool is_closed = false;
};

// The path with every vertex once.
struct CorneredPath {
  std::vector<Vec2> vertices;  // [m]
  std::vector<bool> is_sharp;  // it was named twice
  bool is_closed = false;
};

// Throws InputError that names the vertex: fewer than 2 vertices (3 if closed), one that isn't finite, neighbours at
// the same place (but for two that are a corner, not at the end of an open path), a path that turns by `largest_turn`
// [rad] or more at a vertex, by `largest_corner` at a corner.
CorneredPath requireSound(const Polyline& polyline, double largest_turn, double largest_corner);

// Vertices on a circle about the origin, `turn` [rad] apart, so that neighbouring segments differ by `turn` in
// direction; open, convex, counter-clockwise, symmetric about +y. As many segments as it takes to cover `sweep`
// [rad]: the path may be longer by part of one. Requires radius > 0 [m], 0 < turn < pi, turn <= sweep < 2 pi and
// at most a million segments (InputError).
Polyline arcPolygon(double radius, double turn, double sweep);

}  // namespace pincer::contact
