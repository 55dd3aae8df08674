// convex_features: what the pair routines ask of a convex solid, whatever it is made of.
//
//   solid = core + ball of radius rounding(solid)
//   h(d) = max over the core of d . p,  the core's support function [m for a unit d]
//
//   supportOf  the core's point that is furthest along d; of equally far ones always the same
//   facetOf    the flat, straight or single part of the core's surface that faces along d and holds that point (or lies
//              within the turn of one facet of it): a polygon, a segment (2 corners) or a point (1)
//   strataOf   the kinks of h near d: the normals of flat faces, and the directions of straight edges (h has a kink all
//              along the circle of directions across an edge)
//   bendOf     the second derivative of h at the unit vector d, where h is smooth but not linear: the rims of cylinders
//   insetOf    the same as supportOf, for a solid whose faces lie further in
//
// All in the solid's own frame. A round rim enters facets as kRimCorners points, the first in the direction of d:
// exact for tilting and rolling; between them the outline runs up to 2 % of the radius inside of the circle, but for
// where addRimCorner adds one. Where the rim is further along d than corners that are fixed in the body, the first at
// +x, by kSameGap at most, those stand for it, or they would run round it as it rocks. Shapes that aren't
// convex (half-space, dish, mesh) have no features: isConvex is false, and the functions must not be called.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"
#include "pincer/contact/shape/tolerances.h"

namespace pincer::contact {

constexpr int kRimCorners = 16;  // chords run up to 2 % of the radius inside of the rim; kCos, kSin go with it

struct FacetCorner {
  Vec3 p;                // [m]
  std::uint16_t vertex;  // names that stay the same while the solid turns
  std::uint16_t edge;    // from this corner to the next
};

struct Facet {
  static constexpr int kMost = 40;         // chosen: above a cut cylinder's 18; of more corners every n-th counts
  static constexpr int kFlatEdge = 17;     // of the end of a cylinder with a flat
  std::array<FacetCorner, kMost> corners;  // counter-clockwise seen from outside
  int count = 0;
  Vec3 n = Vec3::UnitZ();  // of the plane of a polygon, out of the solid; otherwise unused
  // of a segment: of the round wall that it is a line of, or of the rounding about it [m]; 0: a sharp edge
  double line_radius = 0;
  double rim_radius = 0;  // of a polygon that stands for the end of a cylinder [m]; otherwise 0

  // True if the edge from corner i to the next is one of the solid's, not a chord of its rim.
  bool isStraight(int i) const {
    return !(rim_radius > 0) || (corners[static_cast<std::size_t>(i)].edge & 31) == kFlatEdge;
  }
  void add(const Vec3& p, int vertex, int edge) {
    if (count < kMost)
      corners[static_cast<std::size_t>(count++)] = {p, static_cast<std::uint16_t>(vertex),
                                                    static_cast<std::uint16_t>(edge)};
  }
};

struct Strata {
  static constexpr int kMost = 8;          // chosen: a box has 3; beyond, those of a hull's corner are left out
  std::array<Vec3, kMost> normals, edges;  // unit
  int normal_count = 0, edge_count = 0;
  bool with_edges = true;  // set before: false leaves out those of hulls, which cost a root each

  void addNormal(const Vec3& n) {
    if (normal_count < kMost) normals[static_cast<std::size_t>(normal_count++)] = n;
  }
  void addEdge(const Vec3& e) {
    if (edge_count < kMost) edges[static_cast<std::size_t>(edge_count++)] = e;
  }
};

// By what share of radius and tilt the furthest point of a rim is further than the nearest of 4 or 16 corners of it, at
// most: 1 - cos of half the angle between two.
inline constexpr double kBetweenFour = 0.29289321881345245, kBetweenSixteen = 0.019214719596769552;

// The first corner of a rim about z, of `radius` [m]; d: x and y of a unit vector, along which it reaches furthest.
inline Vec2 startOfRim(double radius, const Vec2& d, double between) {
  const double tilt = d.norm();
  return between * radius * tilt > kSameGap ? Vec2(radius / tilt * d) : Vec2(radius, 0);
}

bool isConvex(const Shape& shape);
double roundingOf(const Shape& shape);
Vec3 supportOf(const Shape& shape, const Vec3& d);
Vec3 insetOf(const Shape& shape, const Vec3& d);
void facetOf(const Shape& shape, const Vec3& d, Facet& facet);
// To the polygon that stands for the end of a cylinder (rim_radius > 0), the rim's point in the direction of `towards`,
// seen from the axis [m]; unless `towards` is within the polygon.
void addRimCorner(const Vec2& towards, Facet& facet);
// How far the ray from `p` along the unit vector `d` runs until it leaves a capsule or cylinder [m]; where it misses
// the wall, until it is nearest to the axis. Of other solids, until the plane across d through their furthest point.
double reachOf(const Shape& shape, const Vec3& p, const Vec3& d);
void strataOf(const Shape& shape, const Vec3& d, Strata& strata);
Mat3 bendOf(const Shape& shape, const Vec3& d);
bool isRound(const Shape& shape);  // bendOf isn't always zero

}  // namespace pincer::contact
