// Bodies at rest, rolling and tipping: the points that carry them span the
// ground they stand on and keep their identity.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "pincer/contact/pair_query.h"
#include "pincer/contact/shape/direction.h"
#include "pincer/contact/shape/extreme_points.h"
#include "pincer/contact/shape/point_choice.h"
#include "pincer/contact/shape/support.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/pairs.h"
#include "pincer/tests/support/random_poses.h"

namespace pincer::contact {
namespace {

using tests::about;
using tests::featuresOf;
using tests::kMargin;
using tests::kPi;
using tests::kRoundOff;

PairPoints onGround(const Shape& solid, const Pose& X_WA, double margin = kMargin) {
  PairPoints out;
  PatchCache cache(64);
  collideShapes(solid, X_WA, HalfSpace{}, Pose{}, margin, cache, out);
  return out;
}

using Features = std::set<std::uint32_t>;

double crossOf(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

std::vector<Vec2> outlineOf(const PairPoints& p) {
  Vec2 centre = Vec2::Zero();
  for (int i = 0; i < p.count; ++i) centre += p.points[i].p_W.head<2>() / p.count;
  std::vector<Vec2> corners;
  for (int i = 0; i < p.count; ++i) corners.push_back(p.points[i].p_W.head<2>());
  std::sort(corners.begin(), corners.end(), [&](const Vec2& a, const Vec2& b) {
    return std::atan2(a.y() - centre.y(), a.x() - centre.x()) < std::atan2(b.y() - centre.y(), b.x() - centre.x());
  });
  return corners;
}

// Area of the ground that the points enclose (they are in convex position wherever it is used).
double areaOf(const PairPoints& p) {
  const std::vector<Vec2> corners = outlineOf(p);
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) area += 0.5 * crossOf(corners[i], corners[(i + 1) % corners.size()]);
  return area;
}

// How far `q` is inside the enclosed ground; negative outside.
double insideBy(const PairPoints& p, const Vec2& q) {
  const std::vector<Vec2> corners = outlineOf(p);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 edge = corners[(i + 1) % corners.size()] - corners[i];
    least = std::min(least, crossOf(edge, q - corners[i]) / edge.norm());
  }
  return least;
}

TEST(Resting, BoxStandsOnTheFourCornersOfItsFace) {
  const Box box{{0.03, 0.02, 0.01}};
  const PairPoints flat = onGround(box, {Quat::Identity(), {0.1, 0.2, 0.01}});
  EXPECT_EQ(featuresOf(flat), (Features{0, 1, 2, 3}));
  EXPECT_NEAR(areaOf(flat), 4 * 0.03 * 0.02, 1e-17);
  const PairPoints upright = onGround(box, {about(Vec3::UnitY(), kPi / 2), {0, 0, 0.03}});  // x down
  EXPECT_EQ(featuresOf(upright), (Features{1, 3, 5, 7}));
  EXPECT_NEAR(areaOf(upright), 4 * 0.01 * 0.02, 1e-17);
}

TEST(Resting, BoxTipsOverItsEdgeAndBalancesOnItsCorner) {
  const Box box{{0.02, 0.02, 0.02}};
  const PairPoints edge = onGround(box, {about(Vec3::UnitY(), kPi / 4), {0, 0, 0.02 * std::sqrt(2.0)}});
  EXPECT_EQ(featuresOf(edge), (Features{1, 3}));
  const PairPoints corner =
      onGround(box, {Quat::FromTwoVectors(Vec3(1, 1, 1), -Vec3::UnitZ()), {0, 0, 0.02 * std::sqrt(3.0)}});
  EXPECT_EQ(featuresOf(corner), (Features{7}));
  EXPECT_NEAR(corner.points[0].phi, 0, kRoundOff);
}

// A plate thinner than the margin has all eight corners within it. Those that carry must win,
// though the upper ones stick out further.
TEST(Resting, ThinPlateKeepsItsLowerCornersWhenTilted) {
  const Box plate{{0.04, 0.04, 0.0005}};
  for (const double tilt : {0.0, 1e-6, 0.01, 0.05, 0.1}) {
    const Pose X_WA{about(Vec3(1, 2, 0).normalized(), tilt), {0, 0, 0.003}};
    EXPECT_EQ(featuresOf(onGround(plate, X_WA, 0.05)), (Features{0, 1, 2, 3})) << tilt;
  }
}

TEST(Resting, CylinderStandsOnFourPointsOfItsRim) {
  const PairPoints p = onGround(Cylinder{0.03, 0.02}, {Quat::Identity(), {0, 0, 0.02}});
  EXPECT_EQ(featuresOf(p), (Features{4, 5, 6, 7}));
  EXPECT_NEAR(areaOf(p), 2 * 0.03 * 0.03, 1e-17);  // the inscribed square
  const PairPoints turned = onGround(Cylinder{0.03, 0.02}, {about(Vec3::UnitX(), kPi), {0, 0, 0.02}});
  EXPECT_EQ(featuresOf(turned), (Features{0, 1, 2, 3}));
}

// Discs that lay 2 um askew rocked for ever, on points that ran round their rims. As long as four points of the body
// are as low as its rim to a micrometre, they move by the rocking and no more.
TEST(Resting, StandingCylinderKeepsItsPointsWhileItRocks) {
  const Cylinder cylinder{0.03, 0.02};
  const PairPoints still = onGround(cylinder, {Quat::Identity(), {0, 0, 0.02}});
  const double most = kSameGap / ((1 - std::sqrt(0.5)) * cylinder.radius);  // [rad]: a rim halfway between two corners
  for (int i = 0; i < 200; ++i) {
    const double tilt = 0.99 * most * i / 200;
    const PairPoints rocked = onGround(cylinder, {about({std::cos(i), std::sin(i), 0}, tilt), {0, 0, 0.02}});
    ASSERT_EQ(featuresOf(rocked), featuresOf(still));
    double deepest = 0;
    for (int k = 0; k < 4; ++k) {
      ASSERT_LE((rocked.points[k].p_W - still.points[k].p_W).norm(), tilt * 0.04);  // |p| < 0.04 m
      deepest = std::min(deepest, rocked.points[k].phi);
    }
    const double rim =
        0.02 - std::cos(tilt) * cylinder.half_length - std::sin(tilt) * cylinder.radius;  // its lowest [m]
    ASSERT_GE(rim, deepest - kSameGap);
  }
}

// Tilted in any direction and by any angle at which four points are within reach,
// the ground under its centre stays enclosed.
TEST(Resting, TiltedCylinderIsCarriedAroundItsCentre) {
  for (const Shape& solid : {Shape(Cylinder{0.03, 0.02}), Shape(CylinderWithFlat{0.03, 0.02, 0.02})}) {
    for (const double tilt : {0.0, 1e-7, 2e-6, 1e-4, 1e-2}) {
      for (int i = 0; i < 50; ++i) {
        const PairPoints p = onGround(solid, {about({std::cos(i), std::sin(i), 0}, tilt), {0, 0, 0.02}});
        ASSERT_EQ(p.count, 4);
        ASSERT_GE(insideBy(p, Vec2::Zero()),
                  0.001);  // tilted, the low side counts more: of 20 mm to the flat, 2 mm are left in the worst case
      }
    }
  }
}

TEST(Resting, CylinderLiesOnTheTwoEndsOfItsLine) {
  const Cylinder cylinder{0.03, 0.02};
  // rolling: the ends of the line stay the same features, straight below the axis
  for (int degree = 0; degree < 360; ++degree) {
    const Quat rolled = about(Vec3::UnitX(), kPi / 2) * about(Vec3::UnitZ(), degree * kPi / 180);
    const PairPoints p = onGround(cylinder, {rolled, {0, 0, 0.03}});
    ASSERT_EQ(featuresOf(p), (Features{0, 4}));
    ASSERT_LE((p.points[0].p_W - Vec3(0, -0.02, 0)).norm(), kRoundOff);
    ASSERT_LE((p.points[1].p_W - Vec3(0, 0.02, 0)).norm(), kRoundOff);
  }
}

// From its end over its rim to its side: no point that carries jumps, none changes its name.
TEST(Resting, TippingCylinderKeepsItsPoints) {
  const Cylinder cylinder{0.03, 0.02};
  const double step = 1e-3;
  PairPoints before = onGround(cylinder, {about(Vec3::UnitX(), step), {0, 0, 0.03}}, 1);
  int kept = 0;
  for (double tilt = 2 * step; tilt < kPi / 2; tilt += step) {
    const PairPoints now = onGround(cylinder, {about(Vec3::UnitX(), tilt), {0, 0, 0.03}}, 1);
    ASSERT_EQ(now.count, before.count);
    for (int k = 0; k < now.count; ++k) {
      if (now.points[k].feature != before.points[k].feature) continue;
      ++kept;
      ASSERT_LE((now.points[k].p_W - before.points[k].p_W).norm(), 0.04 * step);
    }
    ASSERT_TRUE(featuresOf(now).count(4));  // the deepest rim point of the lower end
    before = now;
  }
  EXPECT_GE(kept, 6000);  // of 6276, four points in each step
}

TEST(Resting, CylinderWithAFlatRestsOnItsFlat) {
  const CylinderWithFlat cylinder{0.025, 0.03, 0.015};   // half chord 0.02
  const Quat flat_down = about(Vec3::UnitY(), kPi / 2);  // x down
  const PairPoints p = onGround(cylinder, {flat_down, {0, 0, 0.015}});
  EXPECT_EQ(featuresOf(p), (Features{8, 9, 10, 11}));
  EXPECT_NEAR(areaOf(p), 0.06 * 0.04, 1e-17);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(p.points[k].phi, 0, kRoundOff);
}

// Rolling on its round, over the edge and on: the height of the lowest point is the
// round's or the edge's, whichever is deeper.
TEST(Resting, CylinderWithAFlatRollsOverItsEdge) {
  const CylinderWithFlat cylinder{0.025, 0.03, 0.015};
  const double open = std::acos(0.6);
  for (int i = 0; i < 720; ++i) {
    const double angle = (i - 360) * kPi / 360;  // of the flat's normal from straight down
    const PairPoints p =
        onGround(cylinder, {about(Vec3::UnitX(), angle) * about(Vec3::UnitY(), kPi / 2), {0, 0, 0.025}}, 0.011);
    ASSERT_GE(p.count, 2);
    const double lowest = std::abs(angle) >= open ? 0.025 : 0.025 * std::cos(open - std::abs(angle));
    double least = 1;
    for (int k = 0; k < p.count; ++k) least = std::min(least, p.points[k].phi);
    ASSERT_NEAR(least, 0.025 - lowest, kRoundOff) << angle;
    ASSERT_GE((p.points[0].p_W - p.points[p.count - 1].p_W).norm(), 0.06 - 1e-12);  // both ends are carried
  }
}

TEST(Resting, CapsuleLiesOnTwoEndsAndStandsOnOne) {
  const Capsule capsule{0.01, 0.03};
  EXPECT_EQ(featuresOf(onGround(capsule, {about(Vec3::UnitX(), kPi / 2), {0, 0, 0.01}})), (Features{0, 1}));
  EXPECT_EQ(featuresOf(onGround(capsule, {Quat::Identity(), {0, 0, 0.04}})), (Features{1}));
  EXPECT_EQ(onGround(Capsule{0.01, 0}, {Quat::Identity(), {0, 0, 0.01}}).count, 1);  // a sphere, once
}

// A hull like a mesh's: rings of many corners.
struct Ring {
  explicit Ring(int n) {
    for (const double z : {0.0, 0.02}) {
      for (int i = 0; i < n; ++i)
        points.emplace_back(0.03 * std::cos(2 * kPi * i / n), 0.03 * std::sin(2 * kPi * i / n), z);
    }
  }
  std::vector<Vec3> points;
};

Features chosen(const Ring& ring, const Pose& X_WA) {
  const SolidFrame A(X_WA);
  const PlaneSupport ground(HalfSpace{}, Pose{}, A);
  const LastPoints none;
  const PointChoice choice({ring.points, {}, 0}, ground, 0.05, none);
  Features features;
  for (int i = 0; i < choice.count(); ++i) features.insert(static_cast<std::uint32_t>(choice[i].index));
  return features;
}

// Of a ring's corners the four furthest from each other, and the same four while it
// rocks within what counts as no difference.
TEST(Resting, ManyCornersAreReducedToFourThatSpanMost) {
  const Ring ring(24);
  EXPECT_EQ(chosen(ring, Pose{}), (Features{0, 6, 12, 18}));
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(chosen(ring, {about({std::cos(i), std::sin(i), 0}, 1e-7), Vec3::Zero()}), (Features{0, 6, 12, 18})) << i;
  }
}

TEST(Resting, TheDeepestOfManyCornersIsAlwaysKept) {
  const Ring ring(1000);
  for (int i = 0; i < 200; ++i) {
    const Pose X_WA{about({std::cos(i), std::sin(i), 0}, 0.001 * i), {0, 0, 0.01}};
    std::uint32_t deepest = 0;
    for (std::uint32_t k = 0; k < ring.points.size(); ++k) {
      if ((X_WA * ring.points[k]).z() < (X_WA * ring.points[deepest]).z()) deepest = k;
    }
    const Features four = chosen(ring, X_WA);
    ASSERT_EQ(four.size(), 4u);
    double nearest = 1;
    for (const std::uint32_t k : four) nearest = std::min(nearest, (X_WA * ring.points[k]).z());
    ASSERT_LE(nearest, (X_WA * ring.points[deepest]).z() + 1e-6);  // or one that counts as equally deep
  }
}

// The rule by which points are chosen as it is written: every point within the margin is scored in every round.

// A polygon's corners, and how far a point is outside it along the normal `n`.
struct Polygon {
  Vec3 n;
  std::vector<Vec3> corners;

  double outside(const Vec3& p) const {
    if (corners.size() == 1) return n.cross(p - corners[0]).norm();
    double distance = -std::numeric_limits<double>::infinity();
    for (const Vec3& a : corners) {
      for (const Vec3& b : corners) {
        const Vec3 right = directionOf<Vec3>((b - a).cross(n), Vec3::Zero()).n;
        const double offset = right.dot(a);
        const bool is_outermost = std::none_of(corners.begin(), corners.end(),
                                               [&](const Vec3& c) { return right.dot(c) - offset > kSameGap; });
        if (&a != &b && is_outermost) distance = std::max(distance, right.dot(p) - offset);
      }
    }
    return distance;
  }
};

// The point that the rule takes next, of those within the margin; -1 for none.
template <class Support>
int nextByRule(const std::vector<Vec3>& points, const Support& support, const Polygon& polygon, double deepest) {
  int next = -1;
  double best = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double gap = support.gap(points[i]), d = gap < kMargin ? polygon.outside(points[i]) : 0;
    const double score = d > 0 ? d * d / (kSameGap + gap - deepest) : 0;
    const bool is_taken = std::find(polygon.corners.begin(), polygon.corners.end(), points[i]) != polygon.corners.end();
    if (is_taken || !(score > kBetter * best)) continue;
    best = score;
    next = static_cast<int>(i);
  }
  return next;
}

template <class Support>
std::vector<int> chosenByRule(const std::vector<Vec3>& points, const Support& support) {
  double deepest = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) deepest = std::min(deepest, support.gap(p));
  std::vector<int> chosen;
  Polygon polygon;
  const auto first =
      std::find_if(points.begin(), points.end(), [&](const Vec3& p) { return support.gap(p) <= deepest + kSameGap; });
  polygon.n = support.normal(*first);
  for (int next = static_cast<int>(first - points.begin()); next >= 0 && chosen.size() < kMaxChosen;) {
    chosen.push_back(next);
    polygon.corners.push_back(points[static_cast<std::size_t>(next)]);
    next = nextByRule(points, support, polygon, deepest);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// Corners of rings below each other, and random ones: some in pairs that are hardly apart, all near the ground.
std::vector<Vec3> cloud(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> anywhere(-1, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 0.1 * i, radius = 0.02 + 1e-4 * (i % 5);
    Vec3 p(radius * std::cos(angle), radius * std::sin(angle), 2e-4 * (i % 5));
    if (i % 3 == 1) p = Vec3(0.02 * anywhere(random), 0.02 * anywhere(random), 5e-4 * (1 + anywhere(random)));
    if (i % 3 == 2) p = points.back() + 1e-6 * Vec3(anywhere(random), anywhere(random), anywhere(random));
    points.push_back(p);
  }
  return points;
}

template <class Support>
void expectTheRule(const std::vector<Vec3>& points, const Support& support) {
  const LastPoints none;
  const PointChoice choice({points, {}, 0}, support, kMargin, none);
  std::vector<int> chosen;
  for (int k = 0; k < choice.count(); ++k) chosen.push_back(choice[k].index);
  EXPECT_EQ(chosen, chosenByRule(points, support)) << points.size() << " points";
}

// Of few points, of as many as are listed, and of more.
TEST(Resting, PointsAreThoseOfTheRuleHoweverManyAreNear) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> tilt(-1e-2, 1e-2);
  for (const int count : {5, 12, 100, 900, 1024, 1025, 3000}) {
    for (int k = 0; k < 20; ++k) {
      const std::vector<Vec3> points = cloud(count, random);
      const double t = k % 2 == 0 ? 0 : 1;
      const SolidFrame A({Quat(1, t * tilt(random), t * tilt(random), 0).normalized(), {0, 0, 1e-5}});
      expectTheRule(points, PlaneSupport(HalfSpace{}, Pose{}, A));
      expectTheRule(points, BowlSupport(Dish{0.15}, Pose{}, A));
    }
  }
}

}  // namespace
}  // namespace pincer::contact
