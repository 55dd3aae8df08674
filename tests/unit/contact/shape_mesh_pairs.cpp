// Meshes against solids and each other: a box's mesh against the box itself, hollows, names, order.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "contact/mesh/generated_meshes.h"
#include "contact/shape/pair_query.h"
#include "contact/shape/separation.h"
#include "contact/surface/smooth_mesh.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/pairs.h"
#include "tests/support/random_numbers.h"
#include "tests/support/random_poses.h"
#include "tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

using tests::around;
using tests::collide;
using tests::direction;
using tests::leastGap;
using tests::NamedShape;
using tests::RandomNumbers;
using tests::rotation;

const Vec3 kMeshHalf(0.031, 0.017, 0.023);

Mesh boxMesh(const Vec3& half) { return {SmoothMesh::build(box(half))}; }

// No contact is deeper than the two overlap along its own normal.
void expectNoneTooDeep(const PairPoints& p, const Shape& a, const Pose& X_BA, const Shape& b) {
  const PosedSolid A{a, X_BA.q.toRotationMatrix(), X_BA.p}, B{b, Mat3::Identity(), Vec3::Zero()};
  for (int k = 0; k < p.count; ++k) {
    const PairPoint& c = p.points[static_cast<std::size_t>(k)];
    EXPECT_GE(c.phi, gapAlong(A, B, c.n_W) - roundingOf(a) - roundingOf(b) - 1e-9);
  }
}

// A box as 12 triangles against the box as a box. Apart, the gap is the distance.
TEST(MeshPairs, MeshOfABoxTouchesSolidsAsTheBox) {
  RandomNumbers random(3);
  const Box box{kMeshHalf};
  const Mesh mesh = boxMesh(kMeshHalf);
  for (const NamedShape& b : tests::sampleConvexSolids()) {
    if (std::holds_alternative<Sphere>(b.shape) || !pairIsSupported(mesh, b.shape)) continue;
    for (int i = 0; i < 60; ++i) {
      const Pose X_BA = around(random, box, b.shape, i % 2 == 0 ? random.uniform(0, 0.0005) : -random.uniform(1e-6, 0.0002));
      const double exact = leastGap(collide(box, X_BA, b.shape, Pose{}, 0.002));
      const PairPoints p = collide(mesh, X_BA, b.shape, Pose{}, 0.002);
      if (exact > 0) {
        EXPECT_NEAR(leastGap(p), exact, 1e-8) << b.name << " " << i;
      } else {
        EXPECT_LT(leastGap(p), 0) << b.name << " " << i;
      }
      expectNoneTooDeep(p, box, X_BA, b.shape);
    }
  }
}

TEST(MeshPairs, MeshOfABoxStandsOnABoxWithItsFourCorners) {
  const Box table{{0.05, 0.05, 0.02}};
  const Pose X{Quat::Identity(), {0.002, 0.001, 0.02 + kMeshHalf.z()}};
  const PairPoints p = collide(boxMesh(kMeshHalf), X, table, Pose{}, 1e-3);
  ASSERT_EQ(p.count, 4);
  for (int k = 0; k < 4; ++k) {
    const PairPoint& c = p.points[static_cast<std::size_t>(k)];
    EXPECT_NEAR(c.phi, 0, 1e-16);
    EXPECT_LE((c.n_W - Vec3::UnitZ()).norm(), 1e-15);
    EXPECT_LE(((c.p_W - X.p).cwiseAbs() - kMeshHalf).norm(), 1e-15);
  }
}

// Overhanging, the points are where the table's rim crosses the body's outline.
TEST(MeshPairs, OverhangingMeshIsCarriedAtTheRim) {
  const Box table{{0.05, 0.05, 0.02}};
  const Pose X{Quat::Identity(), {0.05, 0.001, 0.02 + kMeshHalf.z()}};
  const PairPoints p = collide(boxMesh(kMeshHalf), X, table, Pose{}, 1e-3);
  ASSERT_EQ(p.count, 4);
  double furthest = 0, nearest = 1;
  for (int k = 0; k < 4; ++k) {
    furthest = std::max(furthest, p.points[static_cast<std::size_t>(k)].p_W.x());
    nearest = std::min(nearest, p.points[static_cast<std::size_t>(k)].p_W.x());
    EXPECT_NEAR(p.points[static_cast<std::size_t>(k)].phi, 0, 1e-15);
  }
  EXPECT_NEAR(furthest, 0.05, 1e-12);
  EXPECT_NEAR(nearest, 0.05 - kMeshHalf.x(), 1e-12);
}

// A rod through a ring's hole touches nothing, though it is well inside of the ring's hull; moved sideways it touches where the tube does.
TEST(MeshPairs, HollowsAreHollow) {
  const double major = 0.04, minor = 0.01, r = 0.005;
  const Mesh ring{SmoothMesh::build(torus(major, minor, 96, 48))};
  const Capsule rod{r, 0.03};
  EXPECT_EQ(collide(ring, Pose{}, rod, Pose{}, 1e-3).count, 0);
  const double facets = 2.5e-4;  // e^2 k / 8 of the ring's and the tube's polygons, twice
  for (const double gap : {0.0005, -0.0002}) {
    const PairPoints p = collide(ring, Pose{}, rod, {Quat::Identity(), {major - minor - r - gap, 0, 0}}, 1e-3);
    ASSERT_GE(p.count, 1);
    EXPECT_NEAR(leastGap(p), gap, facets);
    const auto deepest =
        std::min_element(p.points.begin(), p.points.begin() + p.count, [](const auto& x, const auto& y) { return x.phi < y.phi; });
    EXPECT_GT(deepest->n_W.x(), 0.95);  // out of the rod
  }
}

TEST(MeshPairs, OrderOnlyTurnsTheNormal) {
  RandomNumbers random(3);
  const Mesh mesh{SmoothMesh::build(torus(0.03, 0.012, 24, 12))};
  for (const NamedShape& b : tests::sampleConvexSolids()) {
    for (int i = 0; i < 10; ++i) {
      const Pose X{rotation(random), 0.04 * direction(random)};
      const PairPoints ab = collide(mesh, X, b.shape, Pose{}, 1e-3), ba = collide(b.shape, Pose{}, mesh, X, 1e-3);
      ASSERT_EQ(ab.count, ba.count);
      for (int k = 0; k < ab.count; ++k) {
        const auto at = static_cast<std::size_t>(k);
        EXPECT_EQ(ab.points[at].p_W, ba.points[at].p_W);
        EXPECT_EQ(ab.points[at].n_W, -ba.points[at].n_W);
        EXPECT_EQ(ab.points[at].feature, ba.points[at].feature);
      }
    }
  }
}

TEST(MeshPairs, AllocateNothing) {
  RandomNumbers random(4);
  const Mesh mesh{SmoothMesh::build(torus(0.03, 0.012, 24, 12))};
  PatchCache cache(64);
  PairPoints out;
  for (const NamedShape& b : tests::sampleConvexSolids()) {
    for (int i = 0; i < 5; ++i) {
      const Pose X{rotation(random), 0.04 * direction(random)};
      preparePair(mesh, b.shape);
      const std::int64_t before = tests::allocationCount();
      collideShapes(mesh, X, b.shape, Pose{}, 1e-3, cache, out);
      ASSERT_EQ(tests::allocationCount(), before) << b.name;
    }
  }
}

}  // namespace
}  // namespace pincer::contact
