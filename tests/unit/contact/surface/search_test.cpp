// The search for places that face a point, against a look at every triangle.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/surface/outward_float.h"
#include "pincer/contact/surface/surface_search.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::kCreaseAngle;
using tests::RandomNumbers;

struct Searched {
  explicit Searched(const TriangleMesh& mesh) : net(mesh, kCreaseAngle, true), search(net, inspector, nullptr) {}
  SurfaceNet net;
  NetInspector inspector;
  SurfaceSearch search;
};

Vec3 randomPoint(RandomNumbers& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

const ConesAlong kNothingPassed{};

// Calls visit(foot) on the flat mesh's minima nearer than `reach` whose patches may face the point.
template <class Visit>
void visitMinima(const Searched& s, const Vec3& p, double reach, Visit&& visit) {
  constexpr double kAtOnce = 1e-300;
  s.search.visitParts(p, reach, kAtOnce, kNothingPassed, [&](std::int32_t place, double) {
    if (!s.search.part(place).mayHold(p, reach, Facing::front)) return;
    if (const auto foot = s.search.minimumOn(s.net, place, p, reach)) visit(*foot);
  });
}

// A look around a point finds every patch that may face a point nearby, and how far the point has to go for that:
// so those that need further may be skipped.
TEST(SurfaceSearch, VouchesForThePointsAround) {
  constexpr double kAroundPoint = 0.0015, kBound = 0.009;
  for (const TriangleMesh& mesh : {torus(0.03, 0.012, 24, 12), cylinderWithFlat(0.025, 0.03, 0.018, 20, 6),
                                   box({0.02, 0.015, 0.03}), bumpySphere(0.03, 0.1, 6, 10)}) {
    const Searched s(mesh);
    RandomNumbers random(8);
    int later = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = randomPoint(random, 0.05);
      std::map<std::int32_t, double> around;  // triangles, and the way until they matter
      s.search.visitParts(p, kBound, kAroundPoint, kNothingPassed,
                          [&](std::int32_t place, double approach) { around[s.search.triangleAt(place)] = approach; });
      for (const auto& [triangle, way] : around) later += way > 0;
      for (int k = 0; k < 5; ++k) {
        const Vec3 q = p + 0.57 * randomPoint(random, random.uniform(0, kAroundPoint));
        visitMinima(s, q, kBound, [&](const Foot& foot) {
          ASSERT_TRUE(around.contains(foot.triangle)) << mesh.source << ' ' << i;
          EXPECT_LE(around[foot.triangle], (q - p).norm()) << mesh.source << ' ' << i;
        });
      }
    }
    EXPECT_GE(later, 10) << mesh.source;  // 14 and more today: the twelve patches of a box are near from everywhere
  }
}

// Every local minimum of the flat mesh whose patch could face the point is
// visited: the tree and its cones leave none out.
TEST(SurfaceSearch, FindsTheFlatMinimaThatALookAtAllTrianglesFinds) {
  for (const TriangleMesh& mesh :
       {torus(0.03, 0.012, 24, 12), cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), box({0.02, 0.015, 0.03}),
        grooveBlock(M_PI / 4, 0.02, 0.04, 0.04), bumpySphere(0.03, 0.1, 6, 10)}) {
    const Searched s(mesh);
    RandomNumbers random(4);
    int minima = 0;
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = randomPoint(random, 0.05);
      const double bound = random.uniform(0.005, 0.03);
      std::set<std::int32_t> found;
      visitMinima(s, p, bound, [&](const Foot& foot) { found.insert(foot.triangle); });
      for (std::int32_t t = 0; t < s.net.size(); ++t) {
        const FlatPoint flat = closestOnFacet(s.net, t, p);
        // Away from the bound, and where the point is on the facet's or the sharp edge's normal for certain.
        if (flat.distance2 >= bound * bound || !isFlatMinimum(s.net, t, flat, p)) continue;
        Vec3 S = Vec3::Zero();
        for (int k = 0; k < 3; ++k) S += flat.b[static_cast<std::size_t>(k)] * s.net.vertex(t, k);
        const Vec3 facet =
            (s.net.vertex(t, 1) - s.net.vertex(t, 0)).cross(s.net.vertex(t, 2) - s.net.vertex(t, 0)).normalized();
        const bool is_on_facet_normal = facet.dot((p - S).normalized()) > 1 - 1e-9;
        if (!is_on_facet_normal) continue;
        ++minima;
        ASSERT_TRUE(found.contains(t)) << mesh.source << ' ' << i;
      }
    }
    EXPECT_GE(minima, 25) << mesh.source;  // 32 and more today
  }
}

// The nearest place that is in front or behind is the nearest of all, sampled.
TEST(SurfaceSearch, FindsTheNearestPlace) {
  for (const TriangleMesh& mesh :
       {torus(0.03, 0.012, 24, 12), cylinderWithFlat(0.025, 0.03, 0.018, 20, 6), box({0.02, 0.015, 0.03})}) {
    const Searched s(mesh);
    PatchCache cache(64);
    RandomNumbers random(6);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = randomPoint(random, 0.05);
      const SurfaceSeed seed = s.search.nearest(s.net, cache, p, 1, Facing::both);
      ASSERT_TRUE(seed.found);
      double nearest = 1;
      for (std::int32_t t = 0; t < s.net.size(); ++t) {
        const Patch patch = s.net.build(t).patch;
        for (int a = 0; a <= 8; ++a) {
          for (int b = 0; a + b <= 8; ++b) nearest = std::min(nearest, (p - place(patch, a / 8.0, b / 8.0)).norm());
        }
      }
      ASSERT_LT(seed.distance, nearest + 0.5e-3)
          << mesh.source;  // over the flat triangle's closest point; the torus' patches bulge by 0.41 mm
    }
  }
}

// A search is local: it looks at no more of a fine mesh than of a coarse one.
TEST(SurfaceSearch, LooksAtNoMoreOfAFinerMesh) {
  double coarse = 0;
  for (const int level : {3, 4, 5}) {
    const Searched s(icosphere(0.02, level));
    int looked_at = 0;
    for (int i = 0; i < 300; ++i) {
      const double z = 1 - (2.0 * i + 1) / 300, a = 2.399963229728653 * i;
      const Vec3 p = 0.0265 * Vec3(std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z);
      visitMinima(s, p, 0.009, [&](const Foot&) { ++looked_at; });
    }
    EXPECT_GE(looked_at, 300);
    if (level == 3) coarse = looked_at;
    EXPECT_LT(looked_at, 1.3 * coarse) << level;
  }
}

// Between two rims each patch was taken for one that faces everything: all hundred of a wall were listed.
TEST(SurfaceSearch, FewPatchesOfAWallOfOneRowFaceAFinger) {
  const Searched s(cylinder(0.025, 0.03, 50, 1));
  for (const double z : {0.0, 0.01, 0.018}) {
    int listed = 0;
    s.search.visitParts({0.0325, 0, z}, 0.009, 0.001, kNothingPassed, [&](std::int32_t, double) { ++listed; });
    EXPECT_GE(listed, 2) << z;
    EXPECT_LE(listed, 30) << z;
  }
}

TEST(SurfaceSearch, SeesWhatIsHidden) {
  const Searched s(box({0.02, 0.015, 0.03}));
  EXPECT_TRUE(s.search.isHidden(s.net, {0.05, 0, 0}, {-0.05, 0.001, 0.002}));
  EXPECT_TRUE(s.search.isHidden(s.net, {0, 0, 0}, {0, 0.02, 0}));
  EXPECT_FALSE(s.search.isHidden(s.net, {0.05, 0, 0}, {0.021, 0.001, 0.002}));
  EXPECT_FALSE(s.search.isHidden(s.net, {0.05, 0.05, 0}, {0, 0.05, 0}));
}

// No surface normal of a part may be outside of its cone: joining cones only widens them.
TEST(NormalCone, HoldsWhatItWasMadeOf) {
  RandomNumbers random(2);
  int narrow = 0;
  for (int i = 0; i < 2000; ++i) {
    std::array<Vec3, 4> n;
    const Vec3 middle = randomPoint(random, 1).normalized();
    for (Vec3& d : n) d = (middle + random.uniform(0, 0.9) * randomPoint(random, 1)).normalized();
    const NormalCone all = joined(coneOf(std::span(n).first(2)), coneOf(std::span(n).last(2)));
    if (all.isFull()) continue;
    ++narrow;
    for (const Vec3& d : n) ASSERT_GE(all.axis.dot(d), all.cosine - 1e-12);
  }
  EXPECT_GE(narrow, 1900);  // 1996 today
  EXPECT_TRUE(coneOf(std::array{Vec3(1, 0, 0), Vec3(-1, 0.1, 0), Vec3(0, -1, 0)}).isFull());
}

// The tests of four at once leave out none that the tests one by one hold.
TEST(FourLanes, HoldWhatEachHolds) {
  RandomNumbers random(5);
  int held = 0, left_out = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 D = randomPoint(random, 0.02), axis = randomPoint(random, 1).normalized();
    const FacingTest cone(NormalCone{axis, random.uniform(-0.2, 1)});
    const double along = axis.cast<float>().cast<double>().dot(D), R = random.uniform(0, 0.005);
    LaneCones cones{};
    cones.set(i % kLanes, cone);
    const LaneMask may =
        cones.mayFace(inAllLanes(static_cast<float>(along)), inAllLanes(static_cast<float>(D.squaredNorm())),
                      inAllLanes(static_cast<float>(R)));
    if (cone.mayFace(along, D.squaredNorm(), R)) {
      ++held;
      ASSERT_TRUE(may[i % kLanes]) << i;
    }
    left_out += !may[i % kLanes];
  }
  EXPECT_GT(held, 5000);
  EXPECT_GT(left_out, 5000);
}

// Cones that are left out as belonging to a followed contact have all their normals within half of
// the angle at which two contacts are two.
TEST(FourLanes, ConesAlongANormalAreAlongAllOfTheirs) {
  RandomNumbers random(7);
  int along = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = randomPoint(random, 1).normalized(), axis = (n + 0.03 * randomPoint(random, 1)).normalized();
    const double alpha = random.uniform(0, 0.04);
    LaneCones cones{};
    for (int lane = 0; lane < kLanes; ++lane) cones.set(lane, FacingTest(NormalCone{axis, std::cos(alpha)}));
    const ConesAlong passed({n, Vec3::Zero(), Vec3::Zero()});
    if (!passed.hold(cones)[0]) continue;
    ++along;
    ASSERT_LE(std::acos(std::min(1.0, n.dot(axis))) + alpha, std::acos(kHalfApart) + 1e-6);
  }
  EXPECT_GT(along, 1000);
}

// A place x in the ball that C lies over, on a normal in the cone, is never left out.
TEST(NormalCone, FacingIsNeverMissed) {
  RandomNumbers random(3);
  int within = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 axis = randomPoint(random, 1).normalized();
    const double cosine = random.uniform(0, 1), R = random.uniform(0, 0.02);
    Vec3 n = (axis + random.uniform(0, 2) * randomPoint(random, 1)).normalized();
    if (n.dot(axis) < cosine) continue;
    ++within;
    const Vec3 m = randomPoint(random, 0.1), x = m + R * random.uniform(0, 1) * randomPoint(random, 1).normalized();
    const Vec3 D = x + random.uniform(0, 0.05) * n - m;
    const FacingTest test(NormalCone{axis, cosine});
    ASSERT_TRUE(test.mayFace(axis.cast<float>().cast<double>().dot(D), D.squaredNorm(), R * (1 + 1e-12)));
  }
  EXPECT_GE(within, 10'000);  // 14,626 today
}

void expectNextFloats(double x) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto f = static_cast<float>(x);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(contact::above(x)), std::bit_cast<std::uint32_t>(std::nextafter(f, kInf)))
      << x;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(contact::below(x)), std::bit_cast<std::uint32_t>(std::nextafter(f, -kInf)))
      << x;
}

TEST(OutwardFloat, IsTheStandardLibrarysNextOne) {
  RandomNumbers random(4);
  for (int i = 0; i < 10000; ++i) expectNextFloats(random.uniform(-1, 1) * std::exp2(random.uniform(-150, 120)));
  using Limits = std::numeric_limits<float>;
  for (const float f : {0.0f, Limits::denorm_min(), Limits::min(), 1.0f, Limits::max(), Limits::infinity()}) {
    expectNextFloats(f);
    expectNextFloats(-f);
  }
  EXPECT_TRUE(std::isnan(contact::above(Limits::quiet_NaN())) && std::isnan(contact::below(Limits::quiet_NaN())));
}

}  // namespace
}  // namespace pincer::contact
