// A turned solid: its volume and surface against Pappus and Guldin, its outline's mistakes by name.
#include "pincer/contact/mesh/lathe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/mesh_report.h"
#include "pincer/tests/support/error_of.h"

namespace pincer::contact {
namespace {

double enclosedVolume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto p = [&](int i) { return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])]; };
    six += p(0).dot(p(1).cross(p(2)));
  }
  return six / 6;
}

// A regular polygon of n sides has n/(2 pi) sin(2 pi/n) of its circle's area, at every height.
double polygonShare(int n) { return n / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / n); }

TEST(Lathe, TurnsATriangleIntoADoubleConeOfItsVolume) {
  const TriangleMesh mesh = lathe({{0, -0.03}, {0.02, 0}, {0, 0.06}}, 36);
  EXPECT_NO_THROW(requireClosed(mesh));
  const double cone = std::numbers::pi * 0.02 * 0.02 * 0.09 / 3;
  EXPECT_NEAR(enclosedVolume(mesh), cone * polygonShare(36), 1e-12 * cone * 36);  // a sum of 72 terms
}

TEST(Lathe, TurnsARectangleIntoACylinderInEitherDirection) {
  const std::vector<Vec2> up = {{0, 0}, {0.02, 0}, {0.02, 0.05}, {0, 0.05}};
  const double cylinder = std::numbers::pi * 0.02 * 0.02 * 0.05 * polygonShare(24);
  EXPECT_NEAR(enclosedVolume(lathe(up, 24)), cylinder, 1e-15);
  // counter-clockwise from outside all the same
  EXPECT_NEAR(enclosedVolume(lathe({up.rbegin(), up.rend()}, 24)), cylinder, 1e-15);
}

TEST(Lathe, HasAWaistWhereTheProfileHas) {
  const TriangleMesh pawn = lathe({{0, 0}, {0.012, 0}, {0.012, 0.004}, {0.005, 0.012}, {0.009, 0.02}, {0, 0.028}}, 30);
  EXPECT_NO_THROW(requireClosed(pawn));
  EXPECT_EQ(pawn.triangles.size(), 30u * 8);
}

TEST(Lathe, NamesWhatIsWrongWithAProfile) {
  EXPECT_NE(tests::errorOf([] { lathe({{0, 0}, {0, 1}}, 8); }).find("2 points"), std::string::npos);
  EXPECT_NE(tests::errorOf([] { lathe({{0, 0}, {0.1, 0.5}, {0, 1}}, 2); }).find("3 .. 1000"), std::string::npos);
  EXPECT_NE(tests::errorOf([] { lathe({{0.1, 0}, {0.1, 0.5}, {0, 1}}, 8); }).find("profile[0]"), std::string::npos);
  EXPECT_NE(tests::errorOf([] { lathe({{0, 0}, {0, 0.5}, {0, 1}}, 8); }).find("profile[1]"), std::string::npos);
  EXPECT_NE(tests::errorOf([] {
              lathe({{0, 0}, {0.1, 0.5}, {0.1, 0.5}, {0, 1}}, 8);
            }).find("are equal"),
            std::string::npos);
  EXPECT_NE(tests::errorOf([] {
              lathe({{0, 0}, {0.2, 1}, {0.2, 0.2}, {0.05, 0.9}, {0, 1.2}}, 8);
            }).find("crosses itself"),
            std::string::npos);
}

}  // namespace
}  // namespace pincer::contact
