// nearest_outside: the point nearest to a goal on the outer side of a few planes.
//
//   min |x - g|^2   with   n_i . x >= b_i,      x = g + sum lambda_i n_i,   lambda_i >= 0
//
// At most three planes hold a point in space: all sets of up to three are tried, and the
// nearest point that all planes allow is taken.
#pragma once
#include <array>
#include <span>

#include "pincer/contact/math.h"

namespace pincer::grasp {

constexpr int kMostPlanes = 6;  // chosen: up to 41 sets of one to three are tried

struct OuterSide {
  Vec3 n;    // unit
  double b;  // [m]
};
struct NearestOutside {
  Vec3 x;
  std::array<double, kMostPlanes> lambda{};  // [m]
};

// If no point is on the outer side of all, the planes are taken one by one, the last ones counting most.
NearestOutside nearestOutside(std::span<const OuterSide> planes, const Vec3& goal);

}  // namespace pincer::grasp
