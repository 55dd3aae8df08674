// Faces that stand apart over each other: what touchOnFaces says without a search is what the search says.
#include "pincer/contact/shape/face_contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/facet_overlap.h"
#include "pincer/contact/shape/separation.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"

namespace pincer::contact {
namespace {

using tests::about;
using tests::RandomNumbers;

constexpr double kCore = 9.5e-3, kThin = 1.5e-3, kSkin = 5e-4;  // half widths of a pad's core, and its rounding [m]
constexpr double kPadMargin = 2e-3;                             // margin [m]

const Shape& padCore() {
  static const Shape core = [] {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({i & 1 ? kCore : -kCore, i & 2 ? kCore : -kCore, i & 4 ? kThin : -kThin});
    return Convex{Polytope::hullOf(corners, "pad")};
  }();
  return core;
}

struct Under {
  const char* name;
  Shape shape;
  double top;  // over its origin, turned so [m]
  Quat q_WB = Quat::Identity();
};

std::vector<Under> bodies() {
  const Quat lying = about(Vec3(0, 1, 0), M_PI / 2);
  return {{"wide box", Box{Vec3(0.03, 0.03, 0.01)}, 0.01},
          {"narrow box", Box{Vec3(0.03, 0.004, 0.01)}, 0.01},
          {"small box", Box{Vec3(0.005, 0.004, 0.01)}, 0.01},
          {"end of a cylinder", Cylinder{0.018, 0.01}, 0.01},
          {"wall of a cylinder", Cylinder{0.015, 0.03}, 0.015, lying},
          {"wall of a short cylinder", Cylinder{0.015, 0.004}, 0.015, lying},
          {"flat of a cylinder", CylinderWithFlat{0.015, 0.02, 0.012}, 0.012, about(Vec3(0, 1, 0), -M_PI / 2)},
          {"capsule", Capsule{0.01, 0.02}, 0.01, lying},
          {"hull", padCore(), kThin}};
}

struct Posed {
  PosedSolid pad, body;
};

Posed pose(const Under& under, const Quat& q_WF, double lift, const Vec2& aside) {
  const Vec3 way(aside.x(), aside.y(), under.top + kThin + kSkin + lift);
  return {{padCore(), q_WF.toRotationMatrix(), 0.5 * way, kSkin},
          {under.shape, under.q_WB.toRotationMatrix(), -0.5 * way}};
}

double leastOf(const PairPoints& points) {
  double least = kInfinity;
  for (int i = 0; i < points.count; ++i) least = std::min(least, points.points[static_cast<std::size_t>(i)].phi);
  return least;
}

// How far the furthest point of `some` is from all of `others` [m].
double furthest(const PairPoints& some, const PairPoints& others) {
  double most = 0;
  for (int i = 0; i < some.count; ++i) {
    double nearest = kInfinity;
    for (int k = 0; k < others.count; ++k)
      nearest = std::min(
          nearest,
          (some.points[static_cast<std::size_t>(i)].p_W - others.points[static_cast<std::size_t>(k)].p_W).norm());
    most = std::max(most, nearest);
  }
  return most;
}

// Flush, tilted by round-off and by what is seen, over the middle and over edges. The search is
// right to 1e-9 of the size at round walls.
TEST(FaceContact, SaysWhatTheSearchSays) {
  RandomNumbers random(7);
  constexpr double kSize = 0.01;
  constexpr std::array<double, 4> kTilts = {0, 1e-10, 1e-4, 0.02};
  const std::vector<Under> all = bodies();
  for (const Under& under : all) {
    int known = 0;
    for (int n = 0; n < 200; ++n) {
      const Vec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), 0};  // braces: drawn from left to right
      const double yaw = random.uniform(-3, 3), lift = random.uniform(-1e-4, 1e-4);
      const Vec2 aside{random.uniform(-0.008, 0.008), random.uniform(-0.004, 0.004)};
      const auto [pad, body] =
          pose(under, about(axis, kTilts[static_cast<std::size_t>(n % 4)]) * about(Vec3(0, 0, 1), yaw), lift, aside);
      PairPoints quick, searched;
      if (!touchOnFaces(pad, body, {Vec3::UnitZ()}, kSize, kPadMargin, quick)) continue;
      ++known;
      const Separation found = separate(pad, body, kSize);
      overlapFacets(pad, body, found, kSize, kPadMargin, {}, searched);
      ASSERT_GT(quick.count, 0) << under.name << " " << n;
      EXPECT_NEAR(leastOf(quick), leastOf(searched), 1e-11) << under.name << " " << n;
      EXPECT_LT((quick.points[0].n_W - found.n).norm(), 1e-7) << under.name << " " << n;
      EXPECT_LT(furthest(quick, searched), 1e-6) << under.name << " " << n;
      EXPECT_LT(furthest(searched, quick), 1e-6) << under.name << " " << n;
    }
    EXPECT_GE(known, 50) << under.name;  // the flush ones, at the least
  }
}

// Deeper than the pad is round the direction isn't known without a search, nor where no face looks at the other.
TEST(FaceContact, DeclinesWhatItCannotKnow) {
  PairPoints points;
  const Under box = bodies()[0];
  const auto [deep, body] = pose(box, Quat::Identity(), -6e-4, Vec2::Zero());
  EXPECT_FALSE(touchOnFaces(deep, body, {Vec3::UnitZ()}, 0.01, kPadMargin, points));
  const auto [beside, other] = pose(box, Quat::Identity(), 0, Vec2(0.06, 0));
  EXPECT_FALSE(touchOnFaces(beside, other, {Vec3::UnitZ()}, 0.01, kPadMargin, points));
}

TEST(FaceContact, AllocatesNothing) {
  const Under box = bodies()[0];
  const auto [pad, body] = pose(box, Quat::Identity(), 0, Vec2::Zero());
  PairPoints points;
  const std::int64_t before = tests::allocationCount();
  EXPECT_TRUE(touchOnFaces(pad, body, {Vec3::UnitZ()}, 0.01, kPadMargin, points));
  EXPECT_EQ(tests::allocationCount(), before);
  EXPECT_EQ(points.count, 4);
}

}  // namespace
}  // namespace pincer::contact
