// shell_edge: contact with a sharp edge, where no point of the faces fulfils the shell equation.
//
//   (C - E(s)) . D(s) = 0,   D = +- NL x NR + eps E' / L,   contact normal n = +- (C - E) / |C - E|
//
//   E(s)  the edge's cubic, 0 <= s <= 1 [m], L  its chord [m]
//   NL(s), NR(s)  the two sides' normals along it;  eps = 1e-3
//
// The solution lies in the plane of the two normals, so that contact passes from a face to the edge and on
// without a jump, even where the shading normals aren't quite across the curve (with D = E' it would jump by
// h times that error, up to 90 um on coarse meshes). The small part along E' rules where NL = NR: at the
// smooth end of a crease, and on an open border.
#pragma once
#include <array>

#include "pincer/contact/math.h"
#include "pincer/contact/surface/surface_net.h"

namespace pincer::contact {

struct SharpEdge {
  std::array<Vec3, 4> curve;        // [m]
  std::array<Vec3, 3> left, right;  // control points of the sides' normals; equal on an open border
  bool is_border;
};

struct SharpEdgePoint {
  Vec3 E, E1, E2;    // place and derivatives [m]
  Vec3 left, right;  // NL, NR
  Vec3 D, D1;        // D and dD/ds
};

struct EdgeFoot {
  double s;  // 0 or 1: the end is the nearest
  SharpEdgePoint x;
  bool leads_left;   // the left face's step leads into it: contact is there
  bool leads_right;  // the right one's
};

// Edge i of `triangle`; the left side is the triangle's own.
SharpEdge sharpEdge(const SurfaceNet& net, PatchCache& cache, std::int32_t triangle, int i);
SharpEdgePoint evaluate(const SharpEdge& edge, double s);

// Safeguarded Newton (bisection where a step leaves the bracket) from `s`.
EdgeFoot footOnEdge(const SharpEdge& edge, const Vec3& C, double s);

// The normal and signed height of `C` over a point `p` of a feature whose neighbourhood faces along `outward` (of any
// length). Nearer than `on_feature` [m] the direction between the two is lost, and `outward` stands for it.
struct FeatureContact {
  Vec3 n;    // unit
  double h;  // [m]
};
FeatureContact contactWithPoint(const Vec3& C, const Vec3& p, const Vec3& outward, bool is_border, double on_feature);

}  // namespace pincer::contact
