// Convex solids on the smooth surface of a mesh: a ball's mesh against the ball, and slides over facets that must not
// be felt.
#include <gtest/gtest.h>

#include <algorithm>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/pairs.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

using tests::around;
using tests::collide;
using tests::leastGap;
using tests::NamedShape;
using tests::RandomNumbers;

Mesh meshOf(const TriangleMesh& mesh) { return {SmoothMesh::build(mesh)}; }

// The patches over 20 n^2 triangles miss the ball by `error` of its radius at most, as a finger feels them (bench
// contact, accuracy/sphere); the flat triangles by 1 - cos(half of 63 degrees / n): 20 times as much for n = 4, 60
// times for n = 7.
struct Cut {
  int n;
  double error;
};

TEST(SmoothPairs, SolidsTouchTheMeshOfABallAsTheBall) {
  RandomNumbers random(7);
  for (const Cut& cut : {Cut{4, 5e-5}, Cut{7, 6e-6}, Cut{20, 2e-7}}) {
    for (const double radius : {0.004, 0.021, 0.3}) {
      const Sphere ball{radius};
      // On triangles larger than the solid its face is chosen by the triangle's normal, some degrees off (decision 21).
      const double error = cut.n < 20 && radius > 0.1 ? 1e-4 : cut.error;
      const Mesh mesh = meshOf(geodesicSphere(radius, cut.n));
      for (const NamedShape& solid : tests::sampleConvexSolids()) {
        if (std::holds_alternative<Sphere>(solid.shape)) continue;
        for (int i = 0; i < 5; ++i) {
          const Pose X_BA =
              around(random, ball, solid.shape, i % 3 == 0 ? -1e-4 * radius : random.uniform(0, 1e-3 * radius));
          const double exact = leastGap(collide(ball, X_BA, solid.shape, Pose{}));
          EXPECT_NEAR(leastGap(collide(mesh, X_BA, solid.shape, Pose{}, 0.1 * radius)), exact, error * radius + 1e-10)
              << solid.name << " " << cut.n << " " << radius << " " << i;
        }
      }
    }
  }
}

struct Slide {
  const char* name;
  Mesh mesh;
  double height;  // of the place that is touched, from where it slides along +-x and +-y [m]
};

std::vector<Slide> slides() {
  return {{"ball", meshOf(geodesicSphere(0.02, 7)), 0.02},
          {"ellipsoid", meshOf(ellipsoid({0.03, 0.02, 0.015}, 7)), 0.015},
          {"rounded cube", meshOf(roundedCube(0.02, 0.008, 6)), 0.02},
          {"bumpy", meshOf(bumpySphere(0.02, 0.03, 4, 9)), 0.02}};
}

const PairPoint& deepest(const PairPoints& p) {
  return *std::min_element(p.points.begin(), p.points.begin() + p.count,
                           [](const auto& a, const auto& b) { return a.phi < b.phi; });
}

// Steps of a tenth of a micrometre: the gap changes by no more than the way, and the normal as a surface of a
// millimetre's radius turns. On facets normals turn by 0.1 rad at once.
TEST(SmoothPairs, NothingOfTheFacetsIsFeltOnTheWay) {
  constexpr double kStep = 1e-7, kTightest = 1e-3;
  RandomNumbers random(8);
  for (const Slide& slide : slides()) {
    int followed = 0;
    for (const NamedShape& solid : tests::sampleConvexSolids()) {
      if (std::holds_alternative<Sphere>(solid.shape)) continue;
      PatchCache cache(1024);
      for (int place = 0; place < 2; ++place) {
        Pose X_WB{tests::rotation(random), Vec3::Zero()};
        PairPoints found, before;
        // Down onto the mesh, until the deepest point overlaps by 20 um.
        X_WB.p = Vec3(random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004), slide.height + 0.05);
        for (int i = 0; i < 10; ++i) {
          collideShapes(slide.mesh, Pose{}, solid.shape, X_WB, 0.06, cache, found);
          X_WB.p.z() -= found.count > 0 ? 0.9 * (leastGap(found) + 2e-5) : 0.02;
        }
        for (int i = 0; i < 100; ++i) {
          X_WB.p += kStep * Vec3(0.8, 0.6, 0);
          before = found;
          collideShapes(slide.mesh, Pose{}, solid.shape, X_WB, 1e-4, cache, found);
          ASSERT_GT(found.count, 0) << slide.name << " " << solid.name;
          if (i == 0) continue;
          const PairPoint &now = deepest(found), &last = deepest(before);
          EXPECT_LE(std::abs(now.phi - last.phi), 1.5 * kStep)
              << slide.name << " " << solid.name << " " << place << " " << i;
          if (now.feature != last.feature || (now.p_W - last.p_W).norm() > 1e-3) continue;  // another place
          ++followed;
          EXPECT_LE((now.n_W - last.n_W).norm(), kStep / kTightest)
              << slide.name << " " << solid.name << " " << place << " " << i;
        }
      }
    }
    EXPECT_GE(followed, 1300) << slide.name;  // all of 1386: 99 steps, two places, seven solids
  }
}

// A cylinder of one row or of many, lying on a box: carried at both ends whichever way it rocks, as deep as it is.
TEST(SmoothPairs, ALyingCylinderIsCarriedAtBothEndsWhileItRocks) {
  for (const int rows : {1, 2, 8}) {
    for (const int segments : {12, 50, 200}) {
      const Mesh mesh = meshOf(cylinder(0.02, 0.03, segments, rows));
      for (const double tilt : {-1e-4, 0.0, 1e-4}) {
        for (const double roll : {0.0, 0.013, 0.4}) {
          const Quat q = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())) *
                         Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY())) *
                         Quat(Eigen::AngleAxisd(roll, Vec3::UnitZ()));
          const PairPoints p = collide(mesh, {q, Vec3(0, 0, 0.02 - 1e-5)}, Box{{0.1, 0.1, 0.01}},
                                       {Quat::Identity(), Vec3(0, 0, -0.01)}, 1e-3);
          double low = 0, high = 0;
          for (int k = 0; k < p.count; ++k) {
            low = std::min(low, p.points[static_cast<std::size_t>(k)].p_W.x());
            high = std::max(high, p.points[static_cast<std::size_t>(k)].p_W.x());
          }
          EXPECT_NEAR(low, -0.03, 2e-5) << rows << " " << segments << " " << tilt << " " << roll;
          EXPECT_NEAR(high, 0.03, 2e-5) << rows << " " << segments << " " << tilt << " " << roll;
          // A curve between two of 12 corners is off by 30 um at most, the chord by 680.
          EXPECT_NEAR(leastGap(p), -1e-5 - 0.03 * std::abs(tilt), segments < 50 ? 3e-5 : 1e-6)
              << rows << " " << segments << " " << tilt << " " << roll;
        }
      }
    }
  }
}

}  // namespace
}  // namespace pincer::contact
