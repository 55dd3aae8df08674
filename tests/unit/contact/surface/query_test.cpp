#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/mesh_writer.h"
#include "pincer/contact/mesh_reader.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

using tests::kFinger;

constexpr double kTick = 100e-6;  // [m] a finger at 100 mm/s moves this far in 1 ms

// Through the file format, in millimetres, as a user's object comes.
std::shared_ptr<const SmoothMesh> asObject(const TriangleMesh& mesh) {
  const std::string file = formatMesh(mesh, MeshFormat::obj, {.metres_per_unit = 0.001});
  return SmoothMesh::build(parseMesh(file, MeshFormat::obj, mesh.source, {.metres_per_unit = 0.001}));
}

Vec3 onSphere(int i, int n) {  // Fibonacci lattice
  const double z = 1 - (2.0 * i + 1) / n, a = 2.399963229728653 * i;
  return {std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z};
}

// The normal of the facet that a faceted surface gives under C.
Vec3 facetNormalUnder(const TriangleMesh& mesh, const Vec3& C) {
  double deepest = -std::numeric_limits<double>::infinity();
  Vec3 normal = Vec3::UnitZ();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = mesh.vertices[static_cast<std::size_t>(a)];
    const Vec3 n = (mesh.vertices[static_cast<std::size_t>(b)] - p)
                       .cross(mesh.vertices[static_cast<std::size_t>(c)] - p)
                       .normalized();
    const double height = (C - p).dot(n);  // of a convex mesh the facet with the largest height is touched
    if (height > deepest) {
      deepest = height;
      normal = n;
    }
  }
  return normal;
}

struct SphereCase {
  int level;
  // bound of the error [m]: 46.3 and 3.21 um measured at 80 and 320 triangles, a sixteenth of the latter at 1280
  double position;
};

TEST(SurfaceQuery, ASphereOfTrianglesIsASphere) {
  for (const auto& [level, bound] : {SphereCase{1, 47e-6}, {2, 3.3e-6}, {3, 0.25e-6}}) {
    const auto object = asObject(icosphere(0.02, level));
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      SurfaceTracker tracker;
      const Vec3 C = 0.0265 * onSphere(i, 2000);
      const SurfaceContact contact = touch(*object, C, kFinger, tracker);
      worst = std::max(worst, std::abs(contact.p_BS.norm() - 0.02));
    }
    EXPECT_LT(worst, bound) << level;
  }
}

// The equation of finger_query.h, in contact and far away, on smooth surfaces and creases.
TEST(SurfaceQuery, TheCentreLiesOnTheNormalOverTheContact) {
  for (const TriangleMesh& mesh : {icosphere(0.02, 1), torus(0.03, 0.012, 12, 8),
                                   cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), box({0.02, 0.01, 0.03})}) {
    const auto object = asObject(mesh);
    SurfaceTracker tracker;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 C = (0.02 + 0.05 * (i % 7) / 7) * onSphere(i, 3000);
      const SurfaceContact c = touch(*object, C, kFinger, tracker);
      ASSERT_LT((C - c.p_BS - (c.phi + kFinger) * c.n_B).norm(), 1e-15) << mesh.source;  // round-off of 0.1 m
      ASSERT_NEAR(c.n_B.norm(), 1, 1e-14);
    }
  }
}

struct Felt {
  double steepest = 0, shallowest = std::numeric_limits<double>::infinity();  // turn of the normal per tick [rad]
  double depth_ripple = 0;                                                    // [m]
};

Felt slideAroundSphere(const SmoothMesh& object, double depth) {
  const double h = 0.02 + kFinger - depth;
  const Vec3 e1 = Vec3(1, 0.3, 0.2).normalized(), e2 = e1.cross(Vec3(0.1, 0.9, -0.4)).normalized();
  SurfaceTracker tracker;
  Felt felt;
  Vec3 last = Vec3::Zero();
  for (int i = 0; i * kTick < 2 * M_PI * h; ++i) {
    const double a = i * kTick / h;
    const SurfaceContact c = touch(object, h * (std::cos(a) * e1 + std::sin(a) * e2), kFinger, tracker);
    EXPECT_EQ(tracker.status, 0u);
    felt.depth_ripple = std::max(felt.depth_ripple, std::abs(c.phi + depth));
    if (i > 0) {
      felt.steepest = std::max(felt.steepest, angleBetween(last, c.n_B));
      felt.shallowest = std::min(felt.shallowest, angleBetween(last, c.n_B));
    }
    last = c.n_B;
  }
  return felt;
}

// A finger that slides over an ideal sphere turns its contact by tick / h each tick. Facets would hold
// it still and then throw it by the angle between them. What is left of the mesh is a modulation of
// the speed, which dies out as it is refined.
TEST(SurfaceQuery, NoFacetIsFeltOnASphere) {
  struct Case {
    int level;
    double modulation;  // 1.0, 0.3 and 0.07 % measured
  };
  for (const auto& [level, modulation] : {Case{1, 0.02}, {2, 0.005}, {3, 0.001}}) {
    const TriangleMesh mesh = icosphere(0.02, level);
    const auto object = asObject(mesh);
    for (const double depth : {0.001, 0.002}) {
      const double ideal = kTick / (0.02 + kFinger - depth);
      const Felt felt = slideAroundSphere(*object, depth);
      EXPECT_LT(felt.steepest, (1 + modulation) * ideal) << level;
      EXPECT_GT(felt.shallowest, (1 - modulation) * ideal) << level;
      EXPECT_LT(felt.depth_ripple, 40e-6) << level;  // the patch's own error at 80 triangles
    }
    double facet_jump = 0;
    Vec3 last = Vec3::Zero();
    for (int i = 0; i < 1500; ++i) {
      const double a = i * kTick / 0.0265;
      const Vec3 n = facetNormalUnder(mesh, 0.0265 * Vec3(std::cos(a), std::sin(a), 0.3).normalized());
      if (i > 0) facet_jump = std::max(facet_jump, angleBetween(last, n));
      last = n;
    }
    EXPECT_GT(facet_jump, 10 * kTick / 0.0265) << "the baseline must be coarse for the test to mean something";
  }
}

// Of the cylinder with a flat the cross-section is known: an arc, a line, and around the edges
// the finger's centre turns about the edge.
struct CrossSection {
  double R = 0.025, flat = 0.018, h = kFinger - 0.0015;
  double edge_angle = std::acos(flat / R);

  // Normal of the ideal body under a centre `C` at height h in the plane z = const.
  Vec3 normalUnder(const Vec3& C) const {
    const double edge_y = std::sqrt(R * R - flat * flat);
    const double around = std::atan2(std::abs(C.y()), C.x());
    if (C.x() > 0 && std::abs(C.y()) < edge_y && C.x() > flat) return Vec3::UnitX();
    if (around > edge_angle) return Vec3(C.x(), C.y(), 0).normalized();
    return (Vec3(C.x(), C.y(), 0) - Vec3(flat, std::copysign(edge_y, C.y()), 0)).normalized();
  }
  // The centre's path, by its length s.
  Vec3 centreAt(double s) const {
    const double edge_y = R * std::sin(edge_angle);
    const double turn = h * edge_angle, arc = (R + h) * (2 * M_PI - 2 * edge_angle);
    if (s < edge_y) return {flat + h, s, 0};
    s -= edge_y;
    if (s < turn) return Vec3(flat, edge_y, 0) + h * Vec3(std::cos(s / h), std::sin(s / h), 0);
    s -= turn;
    if (s < arc) return (R + h) * Vec3(std::cos(edge_angle + s / (R + h)), std::sin(edge_angle + s / (R + h)), 0);
    s -= arc;
    if (s < turn)
      return Vec3(flat, -edge_y, 0) + h * Vec3(std::cos(s / h - edge_angle), std::sin(s / h - edge_angle), 0);
    return {flat + h, -edge_y + (s - turn), 0};
  }
  double length() const {
    return 2 * R * std::sin(edge_angle) + 2 * h * edge_angle + (R + h) * (2 * M_PI - 2 * edge_angle);
  }
};

TEST(SurfaceQuery, NoFacetIsFeltOnACylinderWithAFlat) {
  const CrossSection ideal;
  const TriangleMesh mesh = cylinderWithFlat(ideal.R, 0.03, ideal.flat, 18, 6);  // 15 degrees per facet
  const auto object = asObject(mesh);
  SurfaceTracker tracker;
  double direction = 0, ripple = 0, facet_error = 0, worst_step = 0;
  Vec3 last_n = Vec3::Zero(), last_ideal = Vec3::Zero();
  for (int i = 0; i * kTick < ideal.length(); ++i) {
    const Vec3 C = ideal.centreAt(i * kTick) + Vec3(0, 0, 0.003);
    const SurfaceContact c = touch(*object, C, kFinger, tracker);
    const Vec3 n = ideal.normalUnder(C);
    direction = std::max(direction, angleBetween(c.n_B, n));
    ripple = std::max(ripple, std::abs(c.phi - (ideal.h - kFinger)));
    facet_error = std::max(facet_error, angleBetween(facetNormalUnder(mesh, C), n));
    if (i > 0) worst_step = std::max(worst_step, std::abs(angleBetween(last_n, c.n_B) - angleBetween(last_ideal, n)));
    last_n = c.n_B;
    last_ideal = n;
    ASSERT_EQ(tracker.status, 0u);
  }
  EXPECT_LT(ripple, 0.5e-6) << "the design's depth ripple at 15 degrees per facet";
  EXPECT_LT(direction, 0.05 * kDegree);
  EXPECT_LT(worst_step, 0.02 * kDegree)
      << "per tick, where the ideal one is 0.18 degrees on the arc and 0.88 about an edge";
  EXPECT_GT(facet_error, 7 * kDegree) << "half a facet's angle: what a faceted surface would give";
}

// At a crease the contact is the edge itself: no point of the faces fulfils the equation there.
TEST(SurfaceQuery, CreasesAndCornersAreExact) {
  const Vec3 half(0.02, 0.015, 0.03);
  const auto object = asObject(box(half));
  int outside = 0;
  for (int i = 0; i < 4000; ++i) {
    // faces, three edges and a corner, from outside and inside
    const Vec3 C = (half + 0.006 * onSphere(i, 4000)).cwiseMax(0.001);
    const bool is_outside = (C.array() > half.array()).any();
    if (!is_outside) continue;
    ++outside;
    SurfaceTracker tracker;
    const SurfaceContact c = touch(*object, C, kFinger, tracker);
    const Vec3 nearest = C.cwiseMin(half);
    ASSERT_LT((c.p_BS - nearest).norm(), 1e-9) << C.transpose();
    ASSERT_LT(c.n_B.cross((C - nearest).normalized()).norm(), 1e-9 / (C - nearest).norm());
    ASSERT_NEAR(c.phi, (C - nearest).norm() - kFinger, 1e-9);
  }
  EXPECT_GE(outside, 3000);  // 3500 of these
}

// The finger's centre may go under the surface; the followed contact stays on its own side of a thin wall.
TEST(SurfaceQuery, AThinWallIsNotCrossed) {
  const Vec3 half(0.02, 0.02, 0.001);
  const auto object = asObject(box(half));
  SurfaceTracker tracker;
  for (int i = 0; i < 200; ++i) {
    const Vec3 C(0.003, 0.004, 0.012 - 0.0001 * i);
    const SurfaceContact c = touch(*object, C, kFinger, tracker);
    ASSERT_EQ(c.n_B, Vec3::UnitZ()) << i;
    ASSERT_NEAR(c.phi, C.z() - half.z() - kFinger, 1e-15);
  }
}

// In free space the nearest part wins, whatever was followed before.
TEST(SurfaceQuery, InFreeSpaceTheNearestPartWins) {
  const auto object = asObject(torus(0.03, 0.008, 24, 12));
  SurfaceTracker tracker;
  for (int i = 0; i <= 100; ++i) {  // across the hole: what was followed becomes the farthest part
    const double x = 0.018 - 0.036 * i / 100;
    const SurfaceContact c = touch(*object, {x, 0.0005, 0}, 0.002, tracker);
    // 24 segments of a tube: the patch's own error
    EXPECT_NEAR(c.phi, 0.022 - std::hypot(x, 0.0005) - 0.002, 30e-6) << x;
    EXPECT_EQ(tracker.status, 0u);
  }
}

TEST(SurfaceQuery, RemembersNothingButTheTracker) {
  const auto object = asObject(cylinderWithFlat(0.025, 0.03, 0.018, 20, 6));
  const auto path = [](int i) -> Vec3 {
    return 0.032 * Vec3(std::cos(0.01 * i), std::sin(0.01 * i), 0.1 * std::sin(0.03 * i));
  };
  const auto slide = [&](std::vector<SurfaceContact>& out) {
    SurfaceTracker tracker;
    for (int i = 0; i < 600; ++i) out.push_back(touch(*object, path(i), kFinger, tracker));
  };
  std::vector<SurfaceContact> a, b;
  std::thread other([&] { slide(a); });
  slide(b);
  other.join();
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].p_BS, b[i].p_BS);
    ASSERT_EQ(a[i].n_B, b[i].n_B);
    ASSERT_EQ(a[i].phi, b[i].phi);
  }
}

TEST(SurfaceQuery, AllocatesNothing) {
  if (!pincer::tests::allocationsAreCounted()) GTEST_SKIP() << "this build can't count allocations";
  const auto object = asObject(cylinderWithFlat(0.025, 0.03, 0.018, 20, 6));
  SurfaceTracker tracker;
  touch(*object, {0.03, 0, 0}, kFinger, tracker);  // this thread's cache
  const std::int64_t before = pincer::tests::allocationCount();
  for (int i = 0; i < 500; ++i) touch(*object, (0.03 + 0.01 * (i % 3)) * onSphere(i, 500), kFinger, tracker);
  EXPECT_EQ(pincer::tests::allocationCount(), before);
}

TEST(SurfaceQuery, HoldsTheContactWhereThereIsNoAnswer) {
  const auto object = asObject(icosphere(0.02, 2));
  SurfaceTracker tracker;
  touch(*object, {0, 0, 0.027}, kFinger, tracker);
  const SurfaceTracker before = tracker;
  touch(*object, {std::nan(""), 0, 0}, kFinger, tracker);
  EXPECT_EQ(tracker.status, kQueryHeldDirection);
  EXPECT_EQ(tracker.slots[0].triangle, before.slots[0].triangle);
  EXPECT_EQ(tracker.slots[0].u, before.slots[0].u);
  const SurfaceContact c = touch(*object, {0, 0.0001, 0.027}, kFinger, tracker);
  EXPECT_EQ(tracker.status, kQueryOk);
  EXPECT_NEAR(c.phi, -0.001, 5e-6);
}

TEST(SurfaceQuery, HullVerticesAreVerticesOfTheMesh) {
  const TriangleMesh mesh = torus(0.03, 0.012, 24, 12);
  const auto object = SmoothMesh::build(mesh);
  EXPECT_LT(object->hullVertices().size(), mesh.vertices.size()) << "the inner side is no part of the hull";
  for (const Vec3& p : object->hullVertices())
    EXPECT_NE(std::find(mesh.vertices.begin(), mesh.vertices.end(), p), mesh.vertices.end());
  double size = 0, hull_size = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 d = onSphere(i, 100);
    size = hull_size = -1;
    for (const Vec3& p : mesh.vertices) size = std::max(size, p.dot(d));
    for (const Vec3& p : object->hullVertices()) hull_size = std::max(hull_size, p.dot(d));
    EXPECT_NEAR(size, hull_size, 1e-8);  // points within 1e-7 of the size may be left out
  }
  EXPECT_GE(object->boundingRadius(), 0.042);
  EXPECT_LT(object->boundingRadius(), 0.043);
}

TEST(SurfaceQuery, RefusesWhatIsNoSurface) {
  TriangleMesh branching = icosphere(0.02, 1);
  branching.triangles.push_back(branching.triangles.front());
  EXPECT_THROW(SmoothMesh::build(branching), InputError);
  EXPECT_THROW(SmoothMesh::build(TriangleMesh{}), InputError);
  EXPECT_THROW(SmoothMesh::build(icosphere(0.02, 1), {.crease_angle = -1}), InputError);
  EXPECT_THROW(SmoothMesh::build(icosphere(0.02, 1), {.crease_angle = std::nan("")}), InputError);
}

TEST(SurfaceQuery, TellsWhatAFingerWillNotFeelWell) {
  EXPECT_TRUE(SmoothMesh::build(icosphere(0.02, 2))->findings(kFinger).empty());
  const auto tight = SmoothMesh::build(torus(0.02, 0.015, 24, 16));  // a hole of 5 mm radius
  ASSERT_EQ(tight->findings(kFinger).size(), 1u);
  EXPECT_NE(tight->findings(kFinger)[0].find("hollow has 5 mm radius; a finger of 8 mm needs 10 mm"), std::string::npos)
      << tight->findings(kFinger)[0];
  EXPECT_TRUE(tight->findings(0.002).empty());
}

// Over the ridge between two places of a hollow tighter than the finger, on a mesh that is its own mirror image: the
// walk stays on the ridge. It was once left without an answer, its place a plane 0.3 um above the surface.
TEST(SurfaceQuery, AFingerOverARidgeOfAHollowThatItDoesNotFitIntoIsAnswered) {
  const auto surface = SmoothMesh::build(bumpySphere(0.03, 0.06, 9, 24));
  for (const double aside : {0.0, 1e-7, -1e-6}) {
    SurfaceTracker tracker;
    PatchCache cache;
    const Vec3 C(0.016661347 + aside, 0.024938140, 0.021988938);
    const SurfaceContacts found = surface->querySphere(C, kFinger, 1e-3, tracker, cache);
    EXPECT_EQ(found.cost.held, 0);
    EXPECT_EQ(tracker.status & kQueryHeldDirection, 0u);
    for (int k = 0; k < found.count; ++k) {
      const SurfaceContact& c = found.points[static_cast<std::size_t>(k)];
      EXPECT_LT((C - c.p_BS - (c.phi + kFinger) * c.n_B).norm(), 1e-15);
    }
  }
}

}  // namespace
}  // namespace pincer::contact
