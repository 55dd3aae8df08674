// Triangulation of polygons: n - 2 pieces, all turned the same way, that fill it
// exactly; also of polygons that are hard to cut.
#include "pincer/contact/mesh/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double shoelace(const std::vector<Vec3>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += p[i].cross(p[(i + 1) % p.size()]).z();
  return 0.5 * twice;
}

void expectFilled(const std::vector<Vec3>& polygon, const char* name) {
  const std::vector<CornerTriple> triangles = triangulate(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << name;
  double area = 0;
  for (const CornerTriple& t : triangles) {
    const double part = 0.5 * (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]).z();
    EXPECT_GT(part, 0) << name;
    area += part;
  }
  // sums of n numbers of about 1
  EXPECT_NEAR(area, shoelace(polygon), 1e-12 * static_cast<double>(polygon.size())) << name;
}

TEST(Polygon, FillsRandomStars) {
  tests::RandomNumbers random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 3 + random.below(60);
    std::vector<Vec3> star;
    for (int i = 0; i < n; ++i) {
      const double angle = kTurn * (i + random.uniform(0, 0.9)) / n, r = random.uniform(0.1, 1);
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    if (n > 3 || shoelace(star) > 0.01) expectFilled(star, "star");
  }
}

// Two arms of a spiral: nearly every corner of the inner one hides an ear of the outer one.
TEST(Polygon, FillsASpiralOfAThousandCorners) {
  std::vector<Vec3> spiral;
  constexpr int kHalf = 500;
  for (int i = 0; i < kHalf; ++i) {
    const double angle = 4 * kTurn * i / kHalf, r = 0.1 + 0.2 * angle / kTurn;
    spiral.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  for (int i = kHalf - 1; i >= 0; --i) {
    const double angle = 4 * kTurn * i / kHalf, r = 0.05 + 0.2 * angle / kTurn;
    spiral.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  std::reverse(spiral.begin(), spiral.end());
  if (shoelace(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  expectFilled(spiral, "spiral");
}

TEST(Polygon, FillsOneWithManyCornersOnItsEdges) {
  std::vector<Vec3> square;
  for (int side = 0; side < 4; ++side) {
    const Vec3 from(side == 1 || side == 2, side >= 2, 0), to(side == 0 || side == 1, side == 1 || side == 2, 0);
    for (int i = 0; i < 16; ++i) square.push_back(from + i / 16.0 * (to - from));
  }
  expectFilled(square, "square of 64 corners");
}

TEST(Polygon, RefusesWhatCrossesItselfOrHasNoArea) {
  EXPECT_TRUE(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).empty());
  EXPECT_TRUE(triangulate({{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 1.5, 0}}).empty()) << "a bow tie";
}

}  // namespace
}  // namespace pincer::contact
