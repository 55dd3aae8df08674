// extreme_points: the points of a solid that can carry it on a support (support.h).
//
//   box                 its corners; feature: bits 0, 1, 2 set where x, y, z are positive
//   capsule             the centres of its ends, rounded by its radius; feature 0 at +z, 1 at -z
//   sphere              its centre, rounded by its radius; feature 0
//   cylinder            four points of each rim, 90 degrees apart; feature 4 e + k, e = 0 at
//                       +z, 1 at -z, k quarter turns from the first
//   cylinder with flat  the same, but none that the flat has cut off, and the flat's
//                       corners: feature 8 + 2 e + (1 where y < 0)
//   convex hull         its corners; feature: the index
//   mesh                the vertices of its convex hull; feature: the index
//
// The first point of a rim is its deepest: it moves along the rim as the cylinder rolls, and is exact for rolling,
// tipping and lying on the side. Where the rim is deeper than four points that are fixed in the body (the first at +x)
// by 1 um at most, those stand for it (startOfRim): a cylinder that rests, or rocks by that, keeps its contacts. (Discs
// that lay 2 um askew rocked for ever on points that ran round the rim.) A mesh rests on the facets of its hull: the
// support does not feel how the smooth surface bulges between the vertices.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "pincer/contact/assert.h"
#include "pincer/contact/math.h"
#include "pincer/contact/shape.h"

namespace pincer::contact {

struct ExtremePoints {
  std::span<const Vec3> points;             // in the solid's frame A [m]
  std::span<const std::uint32_t> features;  // empty where the feature is the index
  double rounding = 0;                      // radius of the solid about each point [m]

  std::uint32_t featureOf(int i) const { return features.empty() ? static_cast<std::uint32_t>(i) : features[i]; }
};

// Where the points of the primitives are written; a mesh brings its own.
struct ExtremePointStore {
  static constexpr int kMost = 12;  // a cylinder with a flat: four of each rim, four of the flat
  std::array<Vec3, kMost> points;
  std::array<std::uint32_t, kMost> features;
  int count = 0;

  void add(const Vec3& p_A, std::uint32_t feature) {
    PINCER_ASSERT(count < kMost);
    points[count] = p_A;
    features[count++] = feature;
  }
};

// `steepest`: of the support, see support.h. The points are sorted by feature; they live in `store` or in
// the shape. HalfSpace and Dish have none.
ExtremePoints extremePoints(const Shape& solid, const Vec2& steepest, ExtremePointStore& store);

}  // namespace pincer::contact
