// A fingertip sphere on every primitive: against the sampled oracle, and against what must hold for any closest point.
#include "pincer/contact/finger_query.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

using tests::kRoundOff;
using tests::NamedShape;
using tests::sampleConvexSolids;
using tests::SampledSurface;
using tests::samplePrimitives;

constexpr double kTip = 0.008;  // fingertip radius [m]

SurfaceContact query(const Shape& shape, const Vec3& p_BC, double r = kTip) {
  SurfaceTracker tracker;
  PatchCache cache(1);
  return querySphere(shape, p_BC, r, 0, tracker, cache).main();
}

double centreDistance(const SurfaceContact& s, double r = kTip) { return s.phi + r; }

// Lengths at which one region of nearest features meets the next.
std::vector<double> borders(const Sphere& s) { return {s.radius}; }
std::vector<double> borders(const Box& b) { return {b.half.x(), b.half.y(), b.half.z()}; }
std::vector<double> borders(const Capsule& c) { return {c.radius, c.half_length}; }
std::vector<double> borders(const Cylinder& c) { return {c.radius, c.half_length}; }
std::vector<double> borders(const CylinderWithFlat& c) {
  const double w = std::sqrt(c.radius * c.radius - c.flat_distance * c.flat_distance);
  // the last two meet on a corner's normal
  return {c.radius, c.half_length, c.flat_distance, w, w * 1.5, c.flat_distance * 1.5};
}
std::vector<double> borders(const HalfSpace&) { return {0}; }
std::vector<double> borders(const Dish& d) { return {d.radius}; }
std::vector<double> borders(const Convex&) { return {}; }
std::vector<double> borders(const Mesh&) { return {}; }

// Points in and around a shape, half of their coordinates exactly on a border between regions, some a hair beside it.
class Probes {
 public:
  explicit Probes(const Shape& shape) : borders_(std::visit([](const auto& s) { return borders(s); }, shape)) {
    borders_.push_back(0);
  }
  Vec3 next() { return {coordinate(), coordinate(), coordinate()}; }
  Vec3 direction() { return Vec3(normal_(random_), normal_(random_), normal_(random_)).normalized(); }
  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }

 private:
  double coordinate() {
    switch (std::uniform_int_distribution(0, 3)(random_)) {
      case 0:
        return onBorder();
      case 1:
        return onBorder() + uniform(-1e-9, 1e-9);
      default:
        return uniform(-0.06, 0.06);
    }
  }
  double onBorder() {
    const std::size_t i = std::uniform_int_distribution<std::size_t>(0, borders_.size() - 1)(random_);
    return (random_() & 1 ? 1 : -1) * borders_[i];
  }

  std::mt19937_64 random_{20110920};
  std::normal_distribution<double> normal_;
  std::vector<double> borders_;
};

class OnEveryPrimitive : public testing::TestWithParam<NamedShape> {};
class OnEveryConvexSolid : public testing::TestWithParam<NamedShape> {};

std::string testName(const testing::TestParamInfo<NamedShape>& info) {
  std::string name = info.param.name;
  std::erase_if(name, [](char c) { return c == ' ' || c == '-'; });
  return name;
}
INSTANTIATE_TEST_SUITE_P(Shapes, OnEveryPrimitive, testing::ValuesIn(samplePrimitives()), testName);
INSTANTIATE_TEST_SUITE_P(Shapes, OnEveryConvexSolid, testing::ValuesIn(sampleConvexSolids()), testName);

TEST_P(OnEveryPrimitive, GapIsTheOracles) {
  const SampledSurface oracle(GetParam().shape);
  Probes probes(GetParam().shape);
  for (int i = 0; i < 150; ++i) {
    const Vec3 c = probes.next();
    EXPECT_NEAR(centreDistance(query(GetParam().shape, c)), oracle.signedDistance(c), SampledSurface::kSamplingError)
        << c.transpose();
  }
}

TEST_P(OnEveryPrimitive, ContactLiesOnTheSurfaceAndFacesOutward) {
  const SampledSurface oracle(GetParam().shape);
  Probes probes(GetParam().shape);
  for (int i = 0; i < 60; ++i) {
    const Vec3 c = probes.next();
    const SurfaceContact s = query(GetParam().shape, c);
    EXPECT_NEAR(oracle.signedDistance(s.p_BS), 0, SampledSurface::kSamplingError) << c.transpose();
    EXPECT_FALSE(oracle.contains(s.p_BS + 1e-7 * s.n_B)) << c.transpose();
  }
}

// 1e-12 is the contract; the forms keep a few ulp.
TEST_P(OnEveryPrimitive, FingerCentreLiesOnTheNormal) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = probes.next();
    const SurfaceContact s = query(GetParam().shape, c);
    ASSERT_NEAR(s.n_B.norm(), 1, 1e-15) << c.transpose();
    ASSERT_LE((c - s.p_BS - centreDistance(s) * s.n_B).norm(), kRoundOff) << c.transpose();
  }
}

// How far the contact stays on the way out: for ever, but in a dish nine tenths of the way to its centre.
double wayOut(const Shape& shape, double d) {
  const auto* dish = std::get_if<Dish>(&shape);
  return dish ? 0.9 * (dish->radius - d) : 0.05;
}

// Along the normal, outwards from anywhere and inwards down to the surface, the contact
// stays and the gap changes by the way gone.
TEST_P(OnEveryPrimitive, GapChangesByTheWayAlongTheNormal) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 c = probes.next();
    const SurfaceContact s = query(GetParam().shape, c);
    const double d = centreDistance(s);
    const double way = probes.uniform(std::min(0.9 * -d, 0.0), wayOut(GetParam().shape, d));
    const SurfaceContact moved = query(GetParam().shape, c + way * s.n_B);
    ASSERT_NEAR(moved.phi, s.phi + way, kRoundOff) << c.transpose();
    // near a dish's centre an ulp turns the normal by 10
    ASSERT_LE((moved.p_BS - s.p_BS).norm(), 10 * kRoundOff) << c.transpose();
  }
}

// A signed distance falls or rises by no more than the way gone, also across the medial axis.
TEST_P(OnEveryPrimitive, GapIsContinuousEverywhere) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = probes.next();
    const double way = std::pow(10, probes.uniform(-12, -2));
    const double change = query(GetParam().shape, c + way * probes.direction()).phi - query(GetParam().shape, c).phi;
    ASSERT_LE(std::abs(change), way + kRoundOff) << c.transpose();
  }
}

// Projection onto a convex set is non-expansive; the normal is the unit vector of
// two moves at the distance of the nearer.
TEST_P(OnEveryConvexSolid, ContactIsContinuousOutside) {
  Probes probes(GetParam().shape);
  int outside = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 c = probes.next();
    const double way = std::pow(10, probes.uniform(-12, -3));
    const SurfaceContact s = query(GetParam().shape, c);
    const SurfaceContact moved = query(GetParam().shape, c + way * probes.direction());
    const double d = std::min(centreDistance(s), centreDistance(moved));
    if (d < 1e-6) continue;
    ++outside;
    ASSERT_LE((moved.p_BS - s.p_BS).norm(), way + kRoundOff) << c.transpose();
    ASSERT_LE((moved.n_B - s.n_B).norm(), 2 * (way + kRoundOff) / d) << c.transpose();
  }
  EXPECT_GT(outside, 10000);
}

TEST_P(OnEveryPrimitive, TheRadiusOnlyShiftsTheGap) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 100; ++i) {
    const Vec3 c = probes.next();
    const SurfaceContact point = query(GetParam().shape, c, 0);
    const SurfaceContact tip = query(GetParam().shape, c, kTip);
    EXPECT_EQ(point.p_BS, tip.p_BS);
    EXPECT_EQ(point.n_B, tip.n_B);
    EXPECT_EQ(point.phi - kTip, tip.phi);
  }
}

TEST_P(OnEveryPrimitive, LowerBoundNeverExceedsTheGap) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 c = probes.next();
    ASSERT_LE(lowerBoundOfGap(GetParam().shape, c, kTip), query(GetParam().shape, c).phi + kRoundOff) << c.transpose();
  }
}

// Far away the bound loses no more than the solid's size: it lets no finger be queried for nothing at 1 m.
TEST_P(OnEveryConvexSolid, LowerBoundIsUsefulFarAway) {
  Probes probes(GetParam().shape);
  for (int i = 0; i < 100; ++i) {
    const Vec3 c = probes.direction();
    const double loss = query(GetParam().shape, c).phi - lowerBoundOfGap(GetParam().shape, c, kTip);
    EXPECT_LE(loss, boundingRadius(GetParam().shape));
  }
}

Vec3 withMinusZeros(const Vec3& v) {
  return v.unaryExpr([](double a) { return a == 0 ? -0.0 : a; });
}

struct Choice {
  std::string name;
  Shape shape;
  Vec3 p_BC;
  Vec3 n_B;
  double distance;
};

// The choice of closed_forms.h where several points of the surface are equally near; -0.0 chooses like 0.0.
TEST(FingerQuery, ChoosesTheSamePointOnTheMedialAxis) {
  const std::vector<Choice> choices = {
      {"centre of a sphere", Sphere{0.02}, {0, 0, 0}, {0, 0, 1}, -0.02},
      {"centre of a cube", Box{{0.02, 0.02, 0.02}}, {0, 0, 0}, {0, 0, 1}, -0.02},
      {"cube, same distance from x and y", Box{{0.02, 0.02, 0.02}}, {0.015, -0.015, 0}, {0, -1, 0}, -0.005},
      {"axis of a capsule", Capsule{0.01, 0.03}, {0, 0, 0.02}, {1, 0, 0}, -0.01},
      {"axis of a cylinder", Cylinder{0.01, 0.03}, {0, 0, 0.01}, {1, 0, 0}, -0.01},
      {"cylinder, same distance from side and end",
       Cylinder{1.0 / 64, 3.0 / 64},
       {0, 0, 2.0 / 64},
       {1, 0, 0},
       -1.0 / 64},
      {"centre of a coin", Cylinder{0.03, 0.01}, {0, 0, 0}, {0, 0, 1}, -0.01},
      {"axis of a cylinder with a flat", CylinderWithFlat{0.02, 0.03, 0.01}, {0, 0, 0}, {1, 0, 0}, -0.01},
      {"centre of a dish", Dish{0.1}, {0, 0, 0.1}, {0, 0, 1}, 0.1}};
  for (const Choice& c : choices) {
    for (const Vec3& p_BC : {c.p_BC, withMinusZeros(c.p_BC)}) {
      const SurfaceContact s = query(c.shape, p_BC);
      EXPECT_EQ(s.n_B, c.n_B) << c.name;
      EXPECT_NEAR(centreDistance(s), c.distance, kRoundOff) << c.name;
    }
  }
}

// Edges, rims and corners: the normal is the direction to the finger's centre (3-4-5
// triangles, exact in doubles up to scale).
TEST(FingerQuery, TouchesSharpFeaturesAlongTheDirectionToTheCentre) {
  const SurfaceContact edge = query(Box{{0.02, 0.02, 0.02}}, {0.023, 0.024, 0.01});
  EXPECT_LE((edge.n_B - Vec3(0.6, 0.8, 0)).norm(), 1e-13);
  EXPECT_LE((edge.p_BS - Vec3(0.02, 0.02, 0.01)).norm(), kRoundOff);
  const SurfaceContact rim = query(Cylinder{0.02, 0.03}, {0, -0.023, 0.034});
  EXPECT_LE((rim.n_B - Vec3(0, -0.6, 0.8)).norm(), 1e-13);
  EXPECT_LE((rim.p_BS - Vec3(0, -0.02, 0.03)).norm(), kRoundOff);
  // corner at (0.03, 0.04)
  const SurfaceContact flat_edge = query(CylinderWithFlat{0.05, 0.03, 0.03}, {0.034, 0.043, 0.01});
  EXPECT_LE((flat_edge.n_B - Vec3(0.8, 0.6, 0)).norm(), 1e-13);
  EXPECT_NEAR(centreDistance(flat_edge), 0.005, kRoundOff);
}

TEST(FingerQuery, StaysFiniteWhereSquaresUnderflow) {
  for (const NamedShape& s : samplePrimitives()) {
    for (const double tiny : {5e-324, 1e-200, 1e-160, 1e-100}) {
      const SurfaceContact c = query(s.shape, Vec3(tiny, -tiny, tiny));
      EXPECT_NEAR(c.n_B.norm(), 1, 1e-14) << s.name << " " << tiny;
      EXPECT_TRUE(c.p_BS.allFinite()) << s.name << " " << tiny;
    }
  }
}

}  // namespace
}  // namespace pincer::contact
