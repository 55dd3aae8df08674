// Hulls of points: corners, and the inner body.
#include "pincer/contact/polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pincer/contact/error.h"

namespace pincer::contact {
namespace {

// In a cube of 60 mm, its corners among them.
std::vector<Vec3> randomPoints(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-0.03, 0.03);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(at(random), at(random), at(random));
  for (int k = 0; k < 8; k += 3) points.emplace_back(k & 1 ? 0.03 : -0.03, k & 2 ? 0.03 : -0.03, k & 4 ? 0.03 : -0.03);
  return points;
}

TEST(Polytope, CornersOfAHullAreItsVertices) {
  for (const int count : {4, 5, 6, 50, 501}) {
    const std::vector<Vec3> points = randomPoints(count);
    EXPECT_EQ(Polytope::cornersOfHull(points, "points"), Polytope::hullOf(points, "points")->vertices()) << count;
  }
}

TEST(Polytope, CornersOfWhatHasNoHullAreRefused) {
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 1e-8}};
  EXPECT_THROW(Polytope::cornersOfHull(flat, "flat"), InputError);
  EXPECT_THROW(Polytope::cornersOfHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "three"), InputError);
  EXPECT_THROW(Polytope::cornersOfHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}, "nan"), InputError);
}

// The bits are those of one product after the other: scenes don't change with how many are formed at a time.
TEST(Polytope, AnInnerBodyIsAsDeepAsItsLeastDeepCorner) {
  for (const int count : {4, 5, 6, 50, 501}) {
    const auto hull = Polytope::hullOf(randomPoints(count), "points");
    double least = INFINITY;
    for (const Polytope::Face& face : hull->faces()) {
      for (const Vec3& p : hull->insetVertices()) least = std::min(least, face.d - face.n.dot(p));
    }
    EXPECT_GT(hull->inset(), 0) << count;
    EXPECT_EQ(hull->inset(), least) << count;
  }
}

}  // namespace
}  // namespace pincer::contact
