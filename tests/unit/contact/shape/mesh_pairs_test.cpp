// Meshes against solids and each other: a box's mesh against the box itself, hollows, names, order.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/separation.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/pairs.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/sampled_surface.h"

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

Mesh meshOf(const Shape& solid) {
  if (const auto* box_solid = std::get_if<Box>(&solid)) return boxMesh(box_solid->half);
  const Polytope& hull = *std::get<Convex>(solid).hull;
  TriangleMesh mesh;
  mesh.vertices = hull.vertices();
  for (const Polytope::Face& face : hull.faces()) {
    const std::span<const int> loop = hull.cornersOf(face);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) mesh.triangles.push_back({loop[0], loop[k], loop[k + 1]});
  }
  return {SmoothMesh::build(mesh)};
}

// A box as 12 triangles, touching a solid or the mesh of one, against the box itself touching the solid. Apart, the gap
// is the distance (to 1e-6 of the size, by which convex solids' corners count as over a face that they are beside).
// Overlapping, contact is found; how deep depends on the feature.
void expectTouchesAsTheBox(RandomNumbers& random, const Shape& solid, const Shape& other, const std::string& name) {
  const Box box{kMeshHalf};
  const Mesh mesh = boxMesh(kMeshHalf);
  for (int i = 0; i < 60; ++i) {
    const Pose X_BA =
        around(random, box, solid, i % 2 == 0 ? random.uniform(0, 0.0005) : -random.uniform(1e-6, 0.0001));
    const double exact = leastGap(collide(box, X_BA, solid, Pose{}, 0.002));
    const PairPoints p = collide(mesh, X_BA, other, Pose{}, 0.002);
    if (exact > 0) {
      EXPECT_NEAR(leastGap(p), exact, 4e-8) << name << " " << i;
    } else {
      EXPECT_LT(leastGap(p), 0) << name << " " << i;
    }
    expectNoneTooDeep(p, box, X_BA, solid);
  }
}

TEST(MeshPairs, MeshOfABoxTouchesSolidsAsTheBox) {
  RandomNumbers random(1);
  for (const NamedShape& b : tests::sampleConvexSolids()) {
    if (!std::holds_alternative<Sphere>(b.shape)) expectTouchesAsTheBox(random, b.shape, b.shape, b.name);
  }
}

// A rim across an edge of the mesh, with the end of the cylinder or another face nearer than a quarter of the depth:
// the way out there was refused for a shorter one that was none.
TEST(MeshPairs, ShallowOverlapIsNeverWithoutAPoint) {
  RandomNumbers random(14);
  const Convex stone{tests::voussoir()};
  for (const Shape& made_from : {Shape(Box{kMeshHalf}), Shape(stone)}) {
    const Mesh mesh = meshOf(made_from);
    for (const NamedShape& b : tests::sampleConvexSolids()) {
      if (std::holds_alternative<Sphere>(b.shape)) continue;
      const bool has_mesh = std::holds_alternative<Box>(b.shape) || std::holds_alternative<Convex>(b.shape);
      const Shape other = has_mesh ? Shape(meshOf(b.shape)) : b.shape;
      for (int i = 0; i < 60; ++i) {
        const Pose X_BA = around(random, made_from, b.shape, -random.uniform(1e-6, 1e-3));
        EXPECT_LT(leastGap(collide(mesh, X_BA, b.shape, Pose{}, 0.002)), 0) << b.name << " " << i;
        EXPECT_LT(leastGap(collide(mesh, X_BA, other, Pose{}, 0.002)), 0) << "mesh of " << b.name << " " << i;
      }
    }
  }
}

TEST(MeshPairs, MeshesOfSolidsTouchAsTheSolids) {
  RandomNumbers random(5);
  for (const NamedShape& b : tests::sampleConvexSolids()) {
    if (std::holds_alternative<Box>(b.shape) || std::holds_alternative<Convex>(b.shape))
      expectTouchesAsTheBox(random, b.shape, meshOf(b.shape), b.name);
  }
}

double segmentDistance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  double best = kInfinity;
  const auto toSegment = [](const Vec3& q, const Vec3& p0, const Vec3& p1) {
    const double t = std::clamp((q - p0).dot(p1 - p0) / (p1 - p0).squaredNorm(), 0.0, 1.0);
    return (q - p0 - t * (p1 - p0)).norm();
  };
  for (const double d : {toSegment(a0, b0, b1), toSegment(a1, b0, b1), toSegment(b0, a0, a1), toSegment(b1, a0, a1)})
    best = std::min(best, d);
  const Vec3 e = a1 - a0, f = b1 - b0, n = e.cross(f), d = b0 - a0;
  if (!(n.squaredNorm() > 0)) return best;
  const double s = d.cross(f).dot(n) / n.squaredNorm(), t = d.cross(e).dot(n) / n.squaredNorm();
  return s >= 0 && s <= 1 && t >= 0 && t <= 1 ? std::min(best, std::abs(d.dot(n)) / n.norm()) : best;
}

double cornerDistance(const Vec3& q, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  for (std::size_t i = 0; i < 3; ++i) {
    if (n.cross(t[(i + 1) % 3] - t[i]).dot(q - t[i]) < 0) return kInfinity;
  }
  return std::abs(n.dot(q - t[0]));
}

bool pierces(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double h0 = n.dot(from - t[0]), h1 = n.dot(to - t[0]);
  return h0 * h1 < 0 && cornerDistance(from + h0 / (h0 - h1) * (to - from), t) < kInfinity;
}

// The distance of two meshes, 0 where they overlap, by trying all pairs of triangles, all their corners and edges.
double distanceOfAll(const TriangleMesh& a, const Pose& X_BA, const TriangleMesh& b) {
  double best = kInfinity;
  const auto cornersOf = [](const TriangleMesh& m, const std::array<std::int32_t, 3>& t, const Pose& X) {
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = X * m.vertices[static_cast<std::size_t>(t[i])];
    return p;
  };
  for (const auto& ta : a.triangles) {
    const std::array<Vec3, 3> p = cornersOf(a, ta, X_BA);
    for (const auto& tb : b.triangles) {
      const std::array<Vec3, 3> q = cornersOf(b, tb, Pose{});
      if ((p[0] - q[0]).norm() > 0.04) continue;  // more than 10 mm apart: no edge here is as long as 15 mm
      for (std::size_t i = 0; i < 3; ++i) {
        if (pierces(p[i], p[(i + 1) % 3], q) || pierces(q[i], q[(i + 1) % 3], p)) return 0;
        best = std::min({best, cornerDistance(p[i], q), cornerDistance(q[i], p)});
        for (std::size_t j = 0; j < 3; ++j)
          best = std::min(best, segmentDistance(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3]));
      }
    }
  }
  return best;
}

// Two rings, linked or not, wherever they come to lie apart.
TEST(MeshPairs, ApartConcaveMeshesAreAsFarAsTheNearestPairOfTriangles) {
  RandomNumbers random(6);
  const TriangleMesh ring = torus(0.03, 0.006, 16, 8);
  const Mesh mesh{SmoothMesh::build(ring)};
  int apart = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose X_BA{rotation(random), 0.05 * direction(random)};
    const PairPoints p = collide(mesh, X_BA, mesh, Pose{}, 0.01);
    const double exact = distanceOfAll(ring, X_BA, ring);
    if (exact > 0.01 || exact == 0) continue;
    EXPECT_GE(leastGap(p), exact - 1e-9) << i;  // round-off of triangles of 15 mm
    EXPECT_LE(leastGap(p), exact + 1e-6)
        << i;  // of points that differ by less, the one of the lowest feature leads, so that it stays the same
    ++apart;
  }
  EXPECT_GE(apart, 8);
}

// A plate on a plate, both thinner than what counts as shallow overlap of
// larger bodies: their far sides stay out of it.
TEST(MeshPairs, ThinPlatesTouchWithTheirNearSidesOnly) {
  const Vec3 half(0.03, 0.03, 0.0005);
  for (const double gap : {1e-5, -1e-6, -1e-5}) {
    for (const double angle : {0.0, 0.3}) {
      const Pose X{Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())), {0.01, 0.002, 2 * half.z() + gap}};
      for (const Shape& other : {Shape(boxMesh(half)), Shape(Box{half})}) {
        const PairPoints p = collide(boxMesh(half), X, other, Pose{}, 1e-4);
        ASSERT_GE(p.count, 3);
        for (int k = 0; k < p.count; ++k) {
          EXPECT_NEAR(p.points[static_cast<std::size_t>(k)].phi, gap, 1e-12);
          EXPECT_LE((p.points[static_cast<std::size_t>(k)].n_W - Vec3::UnitZ()).norm(), 1e-12);
        }
      }
    }
  }
}

// Whatever jitters it by less than 10 nm, each of two equal blocks' corners is at a rim of
// the other: it is carried, not pushed aside.
TEST(MeshPairs, EqualBlocksOnEachOtherAreCarriedAtTheirFourCorners) {
  RandomNumbers random(7);
  const Mesh block = boxMesh(kMeshHalf);
  for (int i = 0; i < 300; ++i) {
    const Pose X{Quat(Eigen::AngleAxisd(1e-8, direction(random))),
                 Vec3(0, 0, 2 * kMeshHalf.z()) + 1e-8 * direction(random)};
    for (const Shape& other : {Shape(block), Shape(Box{kMeshHalf})}) {
      const PairPoints p = collide(block, X, other, Pose{}, 1e-3);
      ASSERT_GE(p.count, 4);
      Vec3 low = p.points[0].p_W, high = low;
      for (int k = 0; k < p.count; ++k) {
        const PairPoint& c = p.points[static_cast<std::size_t>(k)];
        ASSERT_LE((c.n_W - Vec3::UnitZ()).norm(), 1e-7);
        low = low.cwiseMin(c.p_W);
        high = high.cwiseMax(c.p_W);
      }
      ASSERT_LE((high - low - Vec3(2 * kMeshHalf.x(), 2 * kMeshHalf.y(), 0)).cwiseAbs().maxCoeff(), 1e-7);
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

// A rod through a ring's hole touches nothing, though it is well inside of the ring's hull; moved
// sideways it touches where the tube does.
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
    const auto deepest = std::min_element(p.points.begin(), p.points.begin() + p.count,
                                          [](const auto& x, const auto& y) { return x.phi < y.phi; });
    EXPECT_GT(deepest->n_W.x(), 0.95);  // out of the rod
  }
}

// The same of a rod that is a mesh, and of a peg in a square hole: it touches on both
// sides at once, each with its own normal.
TEST(MeshPairs, HollowsOfMeshesAreHollowToMeshes) {
  const double major = 0.04, minor = 0.01, r = 0.005;
  const Mesh ring{SmoothMesh::build(torus(major, minor, 96, 48))}, rod{SmoothMesh::build(cylinder(r, 0.03, 48, 4))};
  EXPECT_EQ(collide(ring, Pose{}, rod, Pose{}, 1e-3).count, 0);
  for (const double gap : {0.0005, -0.0002}) {
    const PairPoints p = collide(ring, Pose{}, rod, {Quat::Identity(), {major - minor - r - gap, 0, 0}}, 1e-3);
    ASSERT_GE(p.count, 1);
    EXPECT_NEAR(leastGap(p), gap, 2.5e-4);
    for (int k = 0; k < p.count; ++k) EXPECT_GT(p.points[static_cast<std::size_t>(k)].n_W.x(), 0.5);  // out of the rod
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
