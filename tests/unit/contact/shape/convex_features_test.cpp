// Features of a convex solid that the pair routines use: support points against the sampled
// surface, facets, bends; hulls from points.
#include "pincer/contact/shape/convex_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pincer/contact/error.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

using tests::direction;
using tests::NamedShape;
using tests::RandomNumbers;
using tests::sampleConvexSolids;
using tests::SampledSurface;

TEST(ConvexFeatures, SupportIsTheOracles) {
  RandomNumbers random(1);
  for (const NamedShape& solid : sampleConvexSolids()) {
    const SampledSurface surface(solid.shape);
    for (int i = 0; i < 20; ++i) {
      const Vec3 d = direction(random);
      const double oracle = -surface.minimum([&](const Vec3& p) { return -d.dot(p); });
      EXPECT_NEAR(d.dot(supportOf(solid.shape, d)) + roundingOf(solid.shape), oracle, SampledSurface::kSamplingError)
          << solid.name;
    }
  }
}

// The facet that faces along d lies on the core's surface, its corners run counter-clockwise,
// and none reaches further than the support.
TEST(ConvexFeatures, FacetsLieOnTheSurfaceCounterClockwise) {
  RandomNumbers random(2);
  int turns = 0;
  for (const NamedShape& solid : sampleConvexSolids()) {
    const SampledSurface surface(solid.shape);
    for (int i = 0; i < 8; ++i) {
      const Vec3 d = direction(random);
      Facet facet;
      facetOf(solid.shape, d, facet);
      ASSERT_GE(facet.count, 1);
      double most = -1;
      for (int k = 0; k < facet.count; ++k) {
        const Vec3& p = facet.corners[static_cast<std::size_t>(k)].p;
        most = std::max(most, d.dot(p));
        ASSERT_LE(d.dot(p - supportOf(solid.shape, d)), 1e-15) << solid.name;
        ASSERT_NEAR(surface.signedDistance(p) + roundingOf(solid.shape), 0, SampledSurface::kSamplingError)
            << solid.name;
        if (facet.count < 3) continue;
        ++turns;
        const Vec3& q = facet.corners[static_cast<std::size_t>((k + 1) % facet.count)].p;
        const Vec3& r = facet.corners[static_cast<std::size_t>((k + 2) % facet.count)].p;
        ASSERT_GT((q - p).cross(r - q).dot(facet.n), 0) << solid.name;
      }
      EXPECT_NEAR(most, d.dot(supportOf(solid.shape, d)), 1e-15) << solid.name;  // one of the corners is the support
    }
  }
  EXPECT_GE(turns, 150);  // 203 today
}

// A ray all but straight out of a wall's end, which is beyond the end's plane by round-off, left a short cylinder
// that pads held 1e-10 m early: it rattled.
TEST(ConvexFeatures, ARimIsWhereTheSolidEnds) {
  const double half = 0.004, beyond = std::nextafter(half, 1), slope = 1e-9, flat = 0.012;
  const Vec3 d = Vec3(1, 0, slope).normalized();
  EXPECT_LE(std::abs(reachOf(Cylinder{0.015, half}, Vec3(0.015, 0, beyond), d)), 1e-17);
  EXPECT_LE(std::abs(reachOf(CylinderWithFlat{0.015, half, flat}, Vec3(flat, 0.009, beyond), d)), 1e-17);
}

// The bend is the derivative of the support point.
TEST(ConvexFeatures, BendIsTheSupportsDerivative) {
  RandomNumbers random(3);
  const double step = 1e-6;
  for (const NamedShape& solid : sampleConvexSolids()) {
    int smooth = 0;
    for (int i = 0; i < 50; ++i) {
      const Vec3 d = direction(random);
      if (d.head<2>().norm() < 0.1 || std::abs(d.z()) < 0.1) continue;  // kinks and the pole
      const Vec3 e = direction(random).cross(d).normalized();
      const Vec3 change = (supportOf(solid.shape, d + step * e) - supportOf(solid.shape, d - step * e)) / (2 * step);
      if (change.norm() > 1) continue;  // across a kink
      ++smooth;
      // third derivatives times step^2, and round-off / step
      EXPECT_LE((bendOf(solid.shape, d) * e - change).norm(), 1e-6) << solid.name;
    }
    EXPECT_GE(smooth, 40) << solid.name;  // 43 to 46 today
  }
}

TEST(Polytope, ACubeOfManyPointsHasSixFaces) {
  std::vector<Vec3> points;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      for (int k = 0; k < 5; ++k) points.emplace_back(0.01 * i, 0.01 * j, 0.01 * k);
    }
  }
  const Quat turned = Quat(0.4, 0.1, -0.7, 0.3).normalized();
  for (Vec3& p : points) p = turned * p;
  const auto cube = Polytope::hullOf(points, "cube");
  EXPECT_EQ(cube->vertices().size(), 8u);
  EXPECT_EQ(cube->edges().size(), 12u);
  ASSERT_EQ(cube->faces().size(), 6u);
  for (const Polytope::Face& face : cube->faces()) EXPECT_EQ(face.count, 4);
}

// Of random points: all within every face, Euler's formula, both sides of each edge.
TEST(Polytope, HoldsItsPointsAndIsClosed) {
  RandomNumbers random(4);
  for (int n = 4; n < 300; n = 2 * n + 1) {
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.push_back(0.05 * direction(random) * random.uniform(0.8, 1));
    const auto hull = Polytope::hullOf(points, "random");
    EXPECT_EQ(hull->vertices().size() + hull->faces().size(), hull->edges().size() + 2);
    for (const Polytope::Face& face : hull->faces()) {
      for (const Vec3& p : points) ASSERT_LE(face.n.dot(p) - face.d, 1e-6 * 0.2);  // kFlat of the size
    }
    for (int i = 0; i < 100; ++i) {  // the climb finds the furthest
      const Vec3 d = direction(random);
      double most = -1;
      for (const Vec3& v : hull->vertices()) most = std::max(most, d.dot(v));
      ASSERT_EQ(d.dot(hull->vertices()[static_cast<std::size_t>(hull->extremeVertex(d))]), most);
    }
    EXPECT_GT(hull->inset(), 0);
    for (const Polytope::Face& face : hull->faces()) {
      for (const Vec3& p : hull->insetVertices()) ASSERT_LE(face.n.dot(p) - face.d, -hull->inset());
    }
  }
}

TEST(Polytope, SaysWhatIsWrong) {
  const std::vector<Vec3> flat = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 0}};
  EXPECT_THROW(Polytope::hullOf(flat, "flat"), InputError);
  EXPECT_THROW(Polytope::hullOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "few"), InputError);
  EXPECT_THROW(Polytope::hullOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}, "nan"), InputError);
  EXPECT_THROW(Polytope::hullOf({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, "one point"), InputError);
}

TEST(Polytope, NearestPointIsTheOracles) {
  RandomNumbers random(5);
  const Convex stone{tests::voussoir()};
  const SampledSurface surface(stone);
  for (int i = 0; i < 200; ++i) {
    const Vec3 q{random.uniform(-0.04, 0.04), random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03)};
    const NearestPoint s = nearestPoint(stone, q);
    ASSERT_NEAR(s.distance, surface.signedDistance(q), SampledSurface::kSamplingError);
    ASSERT_LE((s.p_BS + s.distance * s.n_B - q).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace pincer::contact
