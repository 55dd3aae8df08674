// Pairs of convex solids, judged by trying every direction that may be the best (tasks/judge/exact/convex_gap.h): near,
// touching, overlapping, at any scale, begun anew or from the last answer.
#include <gtest/gtest.h>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/convex_features.h"
#include "pincer/contact/shape/separation.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tasks/judge/exact/convex_gap.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/pairs.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/sampled_surface.h"

namespace pincer::contact {
namespace {

using tasks::convexGap;
using tasks::convexGapAlong;
using tests::about;
using tests::around;
using tests::direction;
using tests::NamedShape;
using tests::RandomNumbers;

constexpr double kSize = 0.03;        // of the solids below [m]
constexpr double kOfRoundRim = 1e-9;  // of the size: what Newton's method and the oracle's sampling leave at worst

// Stout, thin and slim ones.
std::vector<NamedShape> judgedSolids() {
  RandomNumbers random(99);
  std::vector<Vec3> points;
  for (int i = 0; i < 14; ++i) points.push_back(0.03 * direction(random));
  return {{"box", Box{{0.031, 0.017, 0.023}}},
          {"plate", Box{{0.04, 0.03, 0.001}}},
          {"capsule", Capsule{0.013, 0.029}},
          {"cylinder", Cylinder{0.024, 0.019}},
          {"rod", Cylinder{0.004, 0.037}},
          {"coin", Cylinder{0.03, 0.002}},
          {"cylinder with a flat", CylinderWithFlat{0.025, 0.027, 0.014}},
          {"voussoir", Convex{tests::voussoir()}},
          {"stone", Convex{Polytope::hullOf(points, "stone")}}};
}

template <class Judge>
void forAllPairs(Judge judge) {
  const std::vector<NamedShape> solids = judgedSolids();
  for (const NamedShape& a : solids) {
    for (const NamedShape& b : solids) judge(a, b);
  }
}

bool areBoxes(const Shape& a, const Shape& b) {
  return std::holds_alternative<Box>(a) && std::holds_alternative<Box>(b);
}

Vec3 normalOf(const Shape& a, const Pose& X_BA, const Shape& b, const Vec3& last, double margin = 1) {
  PatchCache cache(16);
  PairPoints out;
  collideShapes(a, X_BA, b, Pose{}, margin, cache, out, {last});
  return out.count > 0 ? out.points[0].n_W : Vec3(Vec3::Zero());
}

// From [m] the smallest to the largest gap.
struct Range {
  const char* name;
  double from, to;
};
constexpr Range kRanges[] = {{"far", 1e-3, 1e-2},       {"near", 1e-6, 1e-3},   {"touching", -1e-9, 1e-9},
                             {"shallow", -1e-4, -1e-7}, {"over", -1e-3, -1e-4}, {"deep", -8e-3, -1e-3}};

TEST(PairsJudged, NoDirectionPartsThemBetterThanTheirNormal) {
  RandomNumbers random(7);
  forAllPairs([&](const NamedShape& a, const NamedShape& b) {
    for (const Range& range : kRanges) {
      for (int i = 0; i < tests::draws(3); ++i) {
        const Pose X_BA = around(random, a.shape, b.shape, random.uniform(range.from, range.to));
        const Vec3 n = normalOf(a.shape, X_BA, b.shape, Vec3::Zero());
        const double mine = convexGapAlong(a.shape, X_BA, b.shape, Pose{}, n),
                     best = convexGap(a.shape, X_BA, b.shape, Pose{}).gap;
        // A box's corner beside the other's face by less than 1e-6 of the size counts as over it (facet_overlap.h).
        const double slack = (areBoxes(a.shape, b.shape) ? 1e-6 : kOfRoundRim) * kSize;
        EXPECT_GE(mine, best - slack) << a.name << " at " << b.name << ", " << range.name << " " << i;
      }
    }
  });
}

// A corner of a box within 1e-9 m of a cylinder's rim, each in the other's cone of normals: over most of a quarter turn
// of the direction the gap hardly changes, and the search stopped on the way: 5e-9 of the size.
TEST(PairsJudged, ACornerThatAllButMeetsARimIsPartedAsFarAsCanBe) {
  RandomNumbers random(11);
  const Box box{{0.031, 0.017, 0.023}};
  const Cylinder cylinder{0.024, 0.019};
  for (int i = 0; i < tests::draws(60); ++i) {
    const double rise = random.uniform(0.1, 1.4), around_axis = random.uniform(-3, 3);
    const Vec3 rim(std::cos(around_axis), std::sin(around_axis), 0);
    const Vec3 n = std::cos(rise) * rim + std::sin(rise) * Vec3::UnitZ();
    const Vec3 inwards = Vec3(random.uniform(0.2, 1), random.uniform(0.2, 1), random.uniform(0.2, 1)).normalized();
    const Quat q = about(n, random.uniform(-3, 3)) * Quat::FromTwoVectors(inwards, n);
    const Vec3 meets =
        cylinder.radius * rim + cylinder.half_length * Vec3::UnitZ() + 1e-9 * (0.5 * direction(random) - n);
    const Pose X_BA{q, meets + q * box.half};
    const Vec3 mine = normalOf(box, X_BA, cylinder, Vec3::Zero());
    EXPECT_GE(convexGapAlong(box, X_BA, cylinder, Pose{}, mine),
              convexGap(box, X_BA, cylinder, Pose{}).gap - kOfRoundRim * kSize)
        << i;
  }
}

// Whatever direction the search begins with: the one of before a small step, another's, or one that was never right.
TEST(PairsJudged, TheLastNormalDoesNotChangeTheAnswer) {
  RandomNumbers random(8);
  forAllPairs([&](const NamedShape& a, const NamedShape& b) {
    for (int i = 0; i < tests::draws(24); ++i) {
      const Range& range = kRanges[i % 6];
      Pose X_BA = around(random, a.shape, b.shape, random.uniform(range.from, range.to));
      Vec3 last = i % 3 == 2 ? direction(random) : normalOf(a.shape, X_BA, b.shape, Vec3::Zero());
      if (i % 3 > 0) X_BA = {about(direction(random), 1e-3) * X_BA.q, X_BA.p + 1e-4 * direction(random)};
      const Vec3 cold = normalOf(a.shape, X_BA, b.shape, Vec3::Zero()), warm = normalOf(a.shape, X_BA, b.shape, last);
      const double cold_gap = convexGapAlong(a.shape, X_BA, b.shape, Pose{}, cold);
      const double warm_gap = convexGapAlong(a.shape, X_BA, b.shape, Pose{}, warm);
      EXPECT_NEAR(warm_gap, cold_gap, kOfRoundRim * kSize)
          << a.name << " at " << b.name << ", " << range.name << " " << i;
    }
  });
}

// A body that slides, rolls and is pushed in and out: what it remembers never holds it on
// a way out that has become the longer one.
TEST(PairsJudged, AlongAPathTheLastNormalNeverSticks) {
  RandomNumbers random(9);
  forAllPairs([&](const NamedShape& a, const NamedShape& b) {
    Pose X_BA = around(random, a.shape, b.shape, -2e-4);
    const Vec3 spin = direction(random), way = direction(random);
    Vec3 last = Vec3::Zero();
    for (int i = 0; i < tests::draws(150); ++i) {
      X_BA = {about(spin, 4e-3) * X_BA.q, X_BA.p + 2e-4 * (way - way.dot(X_BA.p) / X_BA.p.squaredNorm() * X_BA.p)};
      const Vec3 cold = normalOf(a.shape, X_BA, b.shape, Vec3::Zero()), warm = normalOf(a.shape, X_BA, b.shape, last);
      EXPECT_NEAR(convexGapAlong(a.shape, X_BA, b.shape, Pose{}, warm),
                  convexGapAlong(a.shape, X_BA, b.shape, Pose{}, cold), kOfRoundRim * kSize)
          << a.name << " at " << b.name << " " << i;
      last = warm;
    }
  });
}

Shape scaled(const Shape& shape, double s) {
  if (const auto* x = std::get_if<Box>(&shape)) return Box{s * x->half};
  if (const auto* x = std::get_if<Capsule>(&shape)) return Capsule{s * x->radius, s * x->half_length};
  if (const auto* x = std::get_if<Cylinder>(&shape)) return Cylinder{s * x->radius, s * x->half_length};
  if (const auto* x = std::get_if<CylinderWithFlat>(&shape))
    return CylinderWithFlat{s * x->radius, s * x->half_length, s * x->flat_distance};
  std::vector<Vec3> points = std::get<Convex>(shape).hull->vertices();
  for (Vec3& p : points) p *= s;
  return Convex{Polytope::hullOf(points, "scaled")};
}

TEST(PairsJudged, ScaleOnlyScalesTheGap) {
  RandomNumbers random(10);
  forAllPairs([&](const NamedShape& a, const NamedShape& b) {
    const Pose X_BA = around(random, a.shape, b.shape, random.uniform(-1e-4, 1e-4));
    const double gap = convexGapAlong(a.shape, X_BA, b.shape, Pose{}, normalOf(a.shape, X_BA, b.shape, Vec3::Zero()));
    for (const double s : {1e-3, 1e3}) {
      const Shape sa = scaled(a.shape, s), sb = scaled(b.shape, s);
      const Pose X{X_BA.q, s * X_BA.p};
      EXPECT_NEAR(convexGapAlong(sa, X, sb, Pose{}, normalOf(sa, X, sb, Vec3::Zero(), s)), s * gap,
                  s * kOfRoundRim * kSize)
          << a.name << " at " << b.name << " times " << s;
    }
  });
}

}  // namespace
}  // namespace pincer::contact
