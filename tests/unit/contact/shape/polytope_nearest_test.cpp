// Nearest points of hulls by the walk from face to face, beside a look at every face.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/direction.h"

namespace pincer::contact {
namespace {

// By definition: the nearest of all points of all faces that `p` is above.
NearestPoint byAllFaces(const Polytope& hull, const Vec3& p) {
  NearestPoint best{p, Vec3::UnitZ(), std::numeric_limits<double>::infinity()};
  for (const Polytope::Face& face : hull.faces()) {
    const double height = face.n.dot(p) - face.d;
    if (!(height > 0)) continue;
    const Vec3 foot = p - height * face.n;
    Vec3 nearest = foot;
    double least = std::numeric_limits<double>::infinity();
    const auto loop = hull.cornersOf(face);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& from = hull.vertices()[static_cast<std::size_t>(loop[k])];
      const Vec3 edge = hull.vertices()[static_cast<std::size_t>(loop[(k + 1) % loop.size()])] - from;
      if (face.n.cross(edge).dot(foot - from) >= 0) continue;
      const Vec3 q = from + std::min(std::max(edge.dot(foot - from) / edge.squaredNorm(), 0.0), 1.0) * edge;
      if ((foot - q).squaredNorm() < least) least = (foot - q).squaredNorm(), nearest = q;
    }
    const auto [n, distance] = directionOf<Vec3>(p - nearest, face.n);
    if (distance < best.distance) best = {nearest, nearest == foot ? face.n : n, distance};
  }
  return best;
}

class NearestOnHulls : public ::testing::Test {
 protected:
  // Points at all distances, over faces, edges and corners alike.
  void compare(const std::vector<Vec3>& points) {
    const auto hull = Polytope::hullOf(points, "test");
    double size = 0;
    for (const Vec3& v : hull->vertices()) size = std::max(size, v.norm());
    for (int i = 0; i < 400; ++i) {
      const Vec3 p =
          std::pow(10.0, spread_(random_)) * size * Vec3(normal_(random_), normal_(random_), normal_(random_));
      check(hull, p);
    }
    for (std::size_t v = 0; v < hull->vertices().size(); v += 1 + hull->vertices().size() / 50) {
      const Vec3& corner = hull->vertices()[v];
      check(hull, corner * (1 + 1e-9));
      check(hull, corner * 1.5);
      const Vec3& other = hull->vertices()[static_cast<std::size_t>(hull->neighboursAt(static_cast<int>(v))[0])];
      check(hull, 1.1 * (0.3 * corner + 0.7 * other));  // over an edge: two faces are as near
    }
    EXPECT_GT(outside_, 200);
  }

  void check(const std::shared_ptr<const Polytope>& hull, const Vec3& p) {
    const NearestPoint found = nearestPoint(Convex{hull}, p);
    if (!(found.distance > 0)) return;
    ++outside_;
    const NearestPoint wanted = byAllFaces(*hull, p);
    EXPECT_EQ(found.distance, wanted.distance);
    EXPECT_EQ(found.p_BS, wanted.p_BS);
    EXPECT_EQ(found.n_B, wanted.n_B);
  }

  std::vector<Vec3> onBall(int count, const Vec3& axes, const Vec3& at = Vec3::Zero()) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
      points.push_back(at + axes.cwiseProduct(Vec3(normal_(random_), normal_(random_), normal_(random_)).normalized()));
    return points;
  }

  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> spread_{-1, 2};
  int outside_ = 0;
};

TEST_F(NearestOnHulls, OfManyCornersAreThoseOfALookAtEveryFace) {
  for (const int count : {4, 5, 8, 20, 100, 1000}) compare(onBall(count, Vec3::Ones()));
}

TEST_F(NearestOnHulls, FlatAndLongAreThoseOfALookAtEveryFace) {
  compare(onBall(300, {1, 1, 0.01}));
  compare(onBall(300, {1, 0.01, 0.01}));
  compare(onBall(100, {1e-3, 1e-3, 1e-3}, {1, 2, 3}));  // far from its frame's origin
}

// Points of a grid on a box and on a prism: faces of many points in one plane, and corners in which few faces meet.
TEST_F(NearestOnHulls, WithLargeFacesAreThoseOfALookAtEveryFace) {
  std::vector<Vec3> box, prism;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) box.emplace_back(i - 1, 2 * (j - 1), 3 * (k - 1));
    }
  }
  for (int i = 0; i < 200; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 200;
    prism.emplace_back(std::cos(angle), std::sin(angle), 1);
    prism.emplace_back(std::cos(angle), std::sin(angle), -1);
  }
  compare(box);
  compare(prism);
}

// A cone's tip joins more faces than are listed.
TEST_F(NearestOnHulls, AtATipOfManyFacesAreThoseOfALookAtEveryFace) {
  std::vector<Vec3> cone = {{0, 0, 1}};
  for (int i = 0; i < 300; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 300;
    cone.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  compare(cone);
  const auto hull = Polytope::hullOf(cone, "cone");
  check(hull, {0, 0, 3});
  check(hull, {1e-3, 0, 1.5});
}

}  // namespace
}  // namespace pincer::contact
