// direction: a vector's length and unit direction, with a fixed choice where it has none.
//
//   v = length * n,  |n| = 1
//   for |v| below 1e-100, whose square would leave the range of doubles:  length = 0, n = the choice
//
// That choice is what makes the closed forms total and deterministic on medial axes. A
// non-finite `v` gives a non-finite result.
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace pincer::contact {

template <class Vector>
struct Direction {
  Vector n;
  double length;
};

// `choice` may be an expression; it is made only where it is needed.
template <class Vector, class Choice>
[[gnu::always_inline]] inline Direction<Vector> directionOf(const Vector& v, const Choice& choice) {
  constexpr double kShortest = 1e-100;  // in the unit of v, see above
  const double length = std::sqrt(v.squaredNorm());
  if (length < kShortest) return {Vector(choice), 0};
  return {v / length, length};
}

}  // namespace pincer::contact
