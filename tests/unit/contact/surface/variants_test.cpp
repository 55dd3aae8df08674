// Shading variants against closed forms: the jump on the finger that facets give, the direction of an
// interpolated normal, how often the published iteration takes how long, and where it fails.
#include <gtest/gtest.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/follow.h"
#include "pincer/contact/surface/surface_net.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/touch.h"

namespace pincer::contact {
namespace {

using tests::direction;
using tests::kFinger;
using tests::RandomNumbers;

constexpr SurfaceVariant kVariants[] = {SurfaceVariant::smooth, SurfaceVariant::facet, SurfaceVariant::force,
                                        SurfaceVariant::smooth_published};

std::shared_ptr<const SmoothMesh> asVariant(const TriangleMesh& mesh, SurfaceVariant variant) {
  SurfaceOptions options;
  options.variant = variant;
  return SmoothMesh::build(mesh, options);
}

Vec3 placeOnFinger(const SurfaceContact& c, const Vec3& C) { return (c.p_BS - C).normalized(); }

struct Jumps {
  double location = 0, direction = 0;  // on the finger [m], of the normal [rad]
  double gap = 0;                      // [m]
};

// Around the 15-degree cylinder of the design, in steps of 1 um, 1 mm deep.
Jumps slideAroundCylinder(SurfaceVariant variant, double step) {
  const auto object = asVariant(cylinder(0.025, 0.03, 24, 6), variant);
  const double h = 0.025 + kFinger - 0.001;
  SurfaceTracker tracker;
  Jumps worst;
  SurfaceContact last{Vec3::Zero(), Vec3::UnitZ()};
  Vec3 last_place = Vec3::Zero();
  for (int i = 0; i * step < 60 * kDegree * h; ++i) {
    const double a = i * step / h;
    const Vec3 C(h * std::cos(a), h * std::sin(a), 0.0021);
    const SurfaceContact c = touch(*object, C, kFinger, tracker);
    EXPECT_EQ(tracker.status, 0u);
    const Vec3 place = placeOnFinger(c, C);
    if (i > 0) {
      worst.location = std::max(worst.location, kFinger * angleBetween(place, last_place));
      worst.direction = std::max(worst.direction, angleBetween(c.n_B, last.n_B));
      worst.gap = std::max(worst.gap, std::abs(c.phi - last.phi));
    }
    last = c;
    last_place = place;
  }
  return worst;
}

TEST(SurfaceVariants, FacetsThrowTheContactByRTheta) {
  const double step = 1e-6, theta = 15 * kDegree;
  const Jumps facet = slideAroundCylinder(SurfaceVariant::facet, step);
  EXPECT_NEAR(facet.location, kFinger * theta, 1e-9) << "2.09 mm";
  EXPECT_NEAR(facet.direction, theta, 1e-9);
  EXPECT_LT(facet.gap, step) << "depth is continuous over the mitre";
  const Jumps force = slideAroundCylinder(SurfaceVariant::force, step);
  EXPECT_NEAR(force.location, kFinger * theta, 1e-9) << "force shading leaves the location where the facet has it";
  EXPECT_LT(force.direction, 1.4 * step / 0.025) << "theta per facet's width, over which the centre moves further";
  EXPECT_LT(force.gap, step);
  for (const SurfaceVariant variant : {SurfaceVariant::smooth, SurfaceVariant::smooth_published}) {
    const Jumps shaded = slideAroundCylinder(variant, step);
    EXPECT_LT(shaded.location, kFinger * 0.001) << "the published iteration ends within 1 um of its solution";
    EXPECT_LT(shaded.gap, step);
  }
}

// Over every facet of a sphere: the plane's own distance and normal; beside it, over
// edges and vertices, the highest facet's.
TEST(SurfaceVariants, FacetsAreTheHighestPlanesOfAConvexMesh) {
  const TriangleMesh mesh = icosphere(0.02, 2);
  const auto object = asVariant(mesh, SurfaceVariant::facet);
  RandomNumbers random(1);
  SurfaceTracker tracker;
  int in_mitres = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 C = random.uniform(0.0195, 0.028) * direction(random);
    double highest = -1;
    Vec3 normal = Vec3::Zero();
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 p = mesh.vertices[static_cast<std::size_t>(a)];
      const Vec3 n = (mesh.vertices[static_cast<std::size_t>(b)] - p)
                         .cross(mesh.vertices[static_cast<std::size_t>(c)] - p)
                         .normalized();
      if ((C - p).dot(n) <= highest) continue;
      highest = (C - p).dot(n);
      normal = n;
    }
    SurfaceTracker fresh;
    const SurfaceContact c = touch(*object, C, kFinger, fresh);
    ASSERT_NEAR(c.phi, highest - kFinger, 1e-15) << i;
    ASSERT_LT((c.n_B - normal).norm(), 1e-12);
    ASSERT_LT((C - c.p_BS - (c.phi + kFinger) * c.n_B).norm(), 1e-16);
    in_mitres += fresh.slots[0].u == 0 || fresh.slots[0].v == 0 || fresh.slots[0].u + fresh.slots[0].v == 1;
  }
  EXPECT_GT(in_mitres, 300);
}

// Morgenbesser & Srinivasan: location and depth of the facet, direction between the corners' normals.
TEST(SurfaceVariants, ForceShadingInterpolatesTheNormalOnTheFacet) {
  const TriangleMesh mesh = icosphere(0.02, 1);
  const auto object = asVariant(mesh, SurfaceVariant::force), facets = asVariant(mesh, SurfaceVariant::facet);
  const SurfaceNet net(mesh, 0.7, true, SurfaceVariant::force);
  RandomNumbers random(2);
  for (int i = 0; i < 500; ++i) {
    const std::int32_t t = random.below(80);
    const double u = random.uniform(0, 0.5), v = random.uniform(0, 0.5);
    const Vec3 p = (1 - u - v) * net.vertex(t, 0) + u * net.vertex(t, 1) + v * net.vertex(t, 2), n = net.facetNormal(t);
    SurfaceTracker tracker, other;
    const Vec3 C = p + 0.007 * n;
    const SurfaceContact c = touch(*object, C, kFinger, tracker), flat = touch(*facets, C, kFinger, other);
    ASSERT_EQ(c.phi, flat.phi);
    ASSERT_EQ(c.p_BS, flat.p_BS);
    ASSERT_NEAR(c.phi, -0.001, 1e-15);
    ASSERT_LT((c.p_BS - p).norm(), 1e-15);
    // the corners' normals of a sphere of equal triangles are radial to 1e-3
    ASSERT_LT((c.n_B - p.normalized()).norm(), 2e-3);
    const Vec3 n0 = net.shadingNormal(t, 0), n1 = net.shadingNormal(t, 1), n2 = net.shadingNormal(t, 2);
    ASSERT_LT((c.n_B - ((1 - u - v) * n0 + u * n1 + v * n2).normalized()).norm(), 1e-13);
  }
}

struct Wandered {
  double mean = 0, failed = 0;  // iterations per query, share of the queries without a solution
  double on_creases = 0;        // share of the queries whose contact is an edge or a vertex
};

// The design's paths: 1 kHz, 30 to 200 mm/s, 0 to 5 mm deep, wandering over the whole surface. Where the variant finds
// no solution, it begins again at the smooth one's.
Wandered wander(const TriangleMesh& mesh, SurfaceVariant variant) {
  const SurfaceNet smooth(mesh, 0.7, true), net(mesh, 0.7, true, variant);
  PatchCache cache(512);
  RandomNumbers random(5);
  Vec3 along = Vec3(0.3, 1, 0.2).normalized(), C(0.03, 0, 0.001);
  Foot truth, foot;
  Wandered counts;
  const int queries = 20000;
  for (int i = 0; i < queries; ++i) {
    const ShellContact ideal = solveShell(smooth, cache, C, truth);
    truth = ideal.foot;
    const PatchPoint x = evaluate(smooth.cell(truth.triangle, cache).patch, truth.b[1], truth.b[2]);
    counts.on_creases += angleBetween(x.N, ideal.n) > 1e-4;
    const ShellContact found = follow({variant, net, cache}, C, kFinger, foot);
    counts.mean += found.cost.steps;
    counts.failed += !found.converged;
    foot = found.converged ? found.foot : truth;
    along += 0.05 * direction(random);
    along = (along - along.dot(ideal.n) * ideal.n).normalized();
    const double speed = 0.115 + 0.085 * std::sin(0.003 * i), depth = 0.0025 - 0.0025 * std::cos(0.0071 * i);
    C += speed * 1e-3 * along + std::clamp(kFinger - depth - ideal.h, -2e-5, 2e-5) * ideal.n;
  }
  for (double* share : {&counts.mean, &counts.failed, &counts.on_creases}) *share /= queries;
  return counts;
}

TEST(SurfaceVariants, ThePublishedIterationTakesTwoToThreeSteps) {
  for (const int level : {1, 2}) {
    const Wandered published = wander(icosphere(0.02, level), SurfaceVariant::smooth_published);
    EXPECT_GT(published.mean, 2.2) << "the design's figure";
    EXPECT_LT(published.mean, 2.3);
    EXPECT_EQ(published.failed, 0);
  }
}

// On creases, rims and corners no surface point fulfils the equation.
TEST(SurfaceVariants, ThePublishedIterationFailsOnCreasesAndSaysSo) {
  const TriangleMesh mesh = cylinderWithFlat(0.025, 0.03, 0.018, 24, 6);
  const Wandered published = wander(mesh, SurfaceVariant::smooth_published),
                 ours = wander(mesh, SurfaceVariant::smooth);
  EXPECT_GT(published.on_creases, 0.1);
  EXPECT_NEAR(published.failed, published.on_creases, 0.01) << "24 % on this path";
  EXPECT_EQ(ours.failed, 0);
}

// Any variant, anywhere, also far inside and outside: finite, of unit length, repeatable, and nothing allocated.
TEST(SurfaceVariants, AnswerEverywhereWithoutAllocating) {
  for (const SurfaceVariant variant : kVariants) {
    for (const TriangleMesh& mesh :
         {torus(0.03, 0.012, 12, 8), cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), box({0.02, 0.01, 0.03})}) {
      const auto object = asVariant(mesh, variant);
      RandomNumbers random(8);
      SurfaceTracker tracker;
      PatchCache cache(256);
      const std::int64_t before = pincer::tests::allocationCount();
      for (int i = 0; i < 1000; ++i) {
        const Vec3 C = random.uniform(0, 0.06) * direction(random);
        const SurfaceContacts found = object->querySphere(C, kFinger, 0, tracker, cache);
        ASSERT_TRUE(found.main().p_BS.allFinite() && std::isfinite(found.main().phi)) << mesh.source;
        // within microns of the surface the way to the centre has fewer digits
        ASSERT_NEAR(found.main().n_B.norm(), 1, 1e-13);
      }
      EXPECT_TRUE(!pincer::tests::allocationsAreCounted() || pincer::tests::allocationCount() == before);
    }
  }
}

TEST(SurfaceVariants, HoldTheContactWhereThereIsNoAnswer) {
  for (const SurfaceVariant variant : kVariants) {
    const auto object = asVariant(icosphere(0.02, 2), variant);
    SurfaceTracker tracker;
    touch(*object, {0, 0, 0.027}, kFinger, tracker);
    const SurfaceSlot before = tracker.slots[0];
    touch(*object, {std::nan(""), 0, 0}, kFinger, tracker);
    EXPECT_EQ(tracker.status, kQueryHeldDirection);
    EXPECT_EQ(tracker.slots[0].triangle, before.triangle);
    touch(*object, {0, 0.0001, 0.027}, kFinger, tracker);
    EXPECT_EQ(tracker.status, kQueryOk);
  }
}

// Flat triangles need no shading normals: 24 bytes per vertex less.
TEST(SurfaceVariants, FacetsKeepNoShadingNormals) {
  const TriangleMesh mesh = icosphere(0.02, 3);
  const std::size_t smooth = asVariant(mesh, SurfaceVariant::smooth)->memoryBytes();
  const std::size_t facet = asVariant(mesh, SurfaceVariant::facet)->memoryBytes();
  EXPECT_GE(smooth, facet + 24 * mesh.vertices.size());
}

// A box pressed on one face until the centre is under it: the face is kept, on both
// flat variants, and its edges are mitres.
TEST(SurfaceVariants, FlatContactFollowsItsFaceUnderTheSurface) {
  for (const SurfaceVariant variant : {SurfaceVariant::facet, SurfaceVariant::force}) {
    const auto object = asVariant(box({0.02, 0.02, 0.001}), variant);
    SurfaceTracker tracker;
    for (int i = 0; i < 200; ++i) {
      const Vec3 C(0.003, 0.004, 0.012 - 0.0001 * i);
      const SurfaceContact c = touch(*object, C, kFinger, tracker);
      ASSERT_LT((c.n_B - Vec3::UnitZ()).norm(), 1e-15) << i;
      ASSERT_NEAR(c.phi, C.z() - 0.001 - kFinger, 1e-15);
    }
  }
}

// An open sheet's border is rolled over, as with the smooth variant: a radial normal about the edge.
TEST(SurfaceVariants, FlatContactRollsOverABorder) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {0.02, 0, 0}, {0.02, 0.02, 0}, {0, 0.02, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const SurfaceVariant variant : {SurfaceVariant::facet, SurfaceVariant::force}) {
    const auto object = asVariant(sheet, variant);
    SurfaceTracker tracker;
    const Vec3 C(0.023, 0.01, 0.004);
    const SurfaceContact c = touch(*object, C, kFinger, tracker);
    EXPECT_LT((c.p_BS - Vec3(0.02, 0.01, 0)).norm(), 1e-16);
    EXPECT_LT((c.n_B - Vec3(0.6, 0, 0.8)).norm(), 1e-14);
    EXPECT_NEAR(c.phi, 0.005 - kFinger, 1e-16);
  }
}

}  // namespace
}  // namespace pincer::contact
