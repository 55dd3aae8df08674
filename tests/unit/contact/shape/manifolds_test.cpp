// The points of bodies that stand or lie on each other: they span what the two share, keep their
// names, and don't depend on the last normal.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/pair_query.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/shape/contact_candidates.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tasks/judge/exact/convex_gap.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/pairs.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/random_poses.h"

namespace pincer::contact {
namespace {

using tests::about;
using tests::direction;
using tests::RandomNumbers;

constexpr double kStandingSize = 0.03;  // of the bodies [m]

struct Standing {
  const char* name;
  Shape shape, solid;  // as it is felt; the same without a mesh
  double low, high;    // from its origin to its flat underside and top [m]
};

std::vector<Standing> standingBodies() {
  const Box box{{0.031, 0.017, 0.023}};
  const Cylinder cylinder{0.024, 0.019};
  std::vector<Vec3> points;  // a frustum of six sides
  for (int i = 0; i < 12; ++i) {
    const double r = i < 6 ? 0.027 : 0.019, t = i * tests::kPi / 3;
    points.emplace_back(r * std::cos(t), r * std::sin(t), i < 6 ? -0.016 : 0.02);
  }
  const Convex hull{Polytope::hullOf(points, "frustum")};
  const Mesh mesh{SmoothMesh::build(contact::box(box.half))}, fine{SmoothMesh::build(gridBox(box.half, 7))};
  return {{"box", box, box, 0.023, 0.023},
          {"cylinder", cylinder, cylinder, 0.019, 0.019},
          {"hull", hull, hull, 0.016, 0.02},
          {"mesh", mesh, box, 0.023, 0.023},
          {"fine mesh", fine, box, 0.023, 0.023}};
}

template <class Judge>
void forAllStanding(Judge judge) {
  const std::vector<Standing> bodies = standingBodies();
  for (const Standing& a : bodies) {
    for (const Standing& b : bodies) judge(a, b);
  }
}

PairPoints askPair(const Shape& a, const Pose& X_BA, const Shape& b, const LastPoints& last = {}) {
  PatchCache cache(16);
  PairPoints out;
  collideShapes(a, X_BA, b, Pose{}, 1e-3, cache, out, last);
  return out;
}

bool isWithin(const Shape& solid, const Vec3& p) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (std::is_same_v<std::decay_t<decltype(s)>, Mesh>)
          return false;
        else
          return nearestPoint(s, p).distance < 0;
      },
      solid);
}

// By a grid over b's top, a hair inside of both: area, and mean place of what they share.
struct SharedFace {
  double area = 0;
  Vec2 centre = Vec2::Zero();

  SharedFace(const Standing& a, const Pose& X_BA, const Standing& b) {
    constexpr double kReach = 0.04, kStep = 5e-4, kHair = 1e-5;  // [m]
    const Pose X_AB = X_BA.inverse();
    for (double x = -kReach; x < kReach; x += kStep) {
      for (double y = -kReach; y < kReach; y += kStep) {
        if (!isWithin(b.solid, {x, y, b.high - kHair}) ||
            !isWithin(a.solid, X_AB * Vec3(x, y, X_BA.p.z() - a.low + kHair)))
          continue;
        area += kStep * kStep;
        centre += kStep * kStep * Vec2(x, y);
      }
    }
    if (area > 0) centre /= area;
  }
};

// Of the convex outline of the points [m^2], and whether `centre` is within it.
struct Outline {
  double area = 0;
  bool holds = true;

  Outline(const PairPoints& p, const Vec2& centre) {
    std::vector<Vec2> corners;
    for (int k = 0; k < p.count; ++k) corners.push_back(p.points[static_cast<std::size_t>(k)].p_W.head<2>());
    Vec2 middle = Vec2::Zero();
    for (const Vec2& c : corners) middle += c / p.count;
    const auto angle = [&](const Vec2& c) { return std::atan2(c.y() - middle.y(), c.x() - middle.x()); };
    std::sort(corners.begin(), corners.end(), [&](const Vec2& c, const Vec2& d) { return angle(c) < angle(d); });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 &c = corners[i], &d = corners[(i + 1) % corners.size()];
      area += 0.5 * cross(c - middle, d - middle);
      holds = holds && cross(d - c, centre - c) > 0;
    }
  }
};

bool isMeshShape(const Shape& shape) { return std::holds_alternative<Mesh>(shape); }

// Four points can't span a disc, nor a polygon of twelve sides: a square spans 2/pi of its circle.
TEST(Manifolds, SpanWhatTheTwoShare) {
  RandomNumbers random(3);
  forAllStanding([&](const Standing& a, const Standing& b) {
    for (int i = 0; i < 6; ++i) {
      const Vec3 beside(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), b.high + a.low - 1e-6);
      const Pose X_BA{about(Vec3::UnitZ(), random.uniform(-3, 3)), beside};
      const SharedFace shared(a, X_BA, b);
      const PairPoints p = askPair(a.shape, X_BA, b.shape);
      ASSERT_GE(p.count, 4) << a.name << " on " << b.name;
      const Outline outline(p, shared.centre);
      EXPECT_TRUE(outline.holds) << a.name << " on " << b.name << " " << i;
      EXPECT_GT(outline.area, 0.6 * shared.area) << a.name << " on " << b.name << " " << i;
      EXPECT_LT(outline.area, 1.02 * shared.area) << a.name << " on " << b.name << " " << i;  // the grid's error
    }
  });
}

// A table's top cut into 2, 200 and 20,000 triangles, and what overhangs its rim, or a corner of it.
TEST(Manifolds, HowAFaceIsCutMakesNoDifference) {
  const Vec3 half(0.15, 0.15, 0.02);
  const Mesh whole{SmoothMesh::build(contact::box(half))};
  const Mesh cut[] = {{SmoothMesh::build(gridBox(half, 10))}, {SmoothMesh::build(gridBox(half, 100))}};
  RandomNumbers random(5);
  for (const Standing& a : standingBodies()) {
    for (int i = 0; i < 6; ++i) {
      const double along = i % 2 == 0 ? random.uniform(-0.1, 0.1) : half.y() + random.uniform(-0.01, 0.005);
      const Pose X_BA{about(Vec3::UnitZ(), random.uniform(-3, 3)),
                      {half.x() + random.uniform(-0.01, 0.005), along, half.z() + a.low - 1e-6}};
      const PairPoints p = askPair(a.shape, X_BA, whole);
      const Outline of_whole(p, Vec2::Zero());
      for (const Mesh& table : cut) {
        const PairPoints q = askPair(a.shape, X_BA, table);
        EXPECT_EQ(q.count, p.count) << a.name << " " << i;
        // round-off
        EXPECT_NEAR(Outline(q, Vec2::Zero()).area, of_whole.area, 1e-9 * of_whole.area) << a.name << " " << i;
      }
    }
  }
}

// A box and its mesh, as what is touched.
std::vector<Shape> boxAndItsMesh(const Vec3& half) { return {Box{half}, Mesh{SmoothMesh::build(contact::box(half))}}; }

// However many triangles are beneath it: those that come last in the mesh aren't forgotten.
TEST(Manifolds, FortyFiveThousandTrianglesBeneathABoxAreAllSeen) {
  const Vec3 half(0.08, 0.06, 0.01);
  const Mesh table{SmoothMesh::build(gridBox(half, 150))};
  for (const Shape& above : boxAndItsMesh({0.079, 0.059, 0.02})) {
    const PairPoints p = askPair(above, {Quat::Identity(), {0, 0, 0.03 - 1e-6}}, table);
    ASSERT_EQ(p.count, 4);
    EXPECT_NEAR(Outline(p, Vec2::Zero()).area, 4 * 0.079 * 0.059, 1e-12);
  }
}

// A capsule or cylinder that lies on a table is held at both of its ends, however
// many of the table's edges it lies across.
TEST(Manifolds, WhatLiesAlongALineIsHeldAtItsEnds) {
  const Vec3 half(0.08, 0.08, 0.02);
  const double radius = 0.012, half_length = 0.03;
  RandomNumbers random(7);
  for (const int cuts : {1, 7, 40}) {
    const Mesh table{SmoothMesh::build(gridBox(half, cuts))};
    for (const Shape& lying : {Shape(Capsule{radius, half_length}), Shape(Cylinder{radius, half_length})}) {
      for (int i = 0; i < 20; ++i) {
        const Quat q = about(Vec3::UnitZ(), random.uniform(-3, 3)) * about(Vec3::UnitY(), tests::kPi / 2);
        const Vec3 beside(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), half.z() + radius - 1e-6);
        const PairPoints p = askPair(lying, {q, beside}, table);
        double low = 0, high = 0;
        for (int k = 0; k < p.count; ++k) {
          const double along = (q * Vec3::UnitZ()).dot(p.points[static_cast<std::size_t>(k)].p_W - beside);
          low = std::min(low, along);
          high = std::max(high, along);
        }
        EXPECT_NEAR(low, -half_length, 1e-9) << cuts << " " << i << " " << lying.index();
        EXPECT_NEAR(high, half_length, 1e-9) << cuts << " " << i << " " << lying.index();
      }
    }
  }
}

LastPoints lastOf(const PairPoints& points) {
  LastPoints last{points.points[0].n_W};
  for (int k = 0; k < points.count; ++k) last.add(points.points[static_cast<std::size_t>(k)].feature, false);
  return last;
}

// A heap of discs never came to rest: the four of a face's points that carry were others in nearly every tick, as the
// round-off of the tilt had it, and each new one began without its impulse.
TEST(Manifolds, AFaceThatRocksByLessThanAMicrometreKeepsItsPoints) {
  const Shape discs[] = {Cylinder{0.016, 0.004}, CylinderWithFlat{0.016, 0.004, 0.011}, Box{{0.012, 0.01, 0.004}}};
  for (const Shape& lower : discs) {
    for (const Shape& upper : discs) {
      const auto ask = [&](double x, double tilt, const LastPoints& last) {
        const Vec3 axis(std::cos(x), std::sin(x), 0);
        const Quat q = about(axis, tilt) * about(Vec3::UnitZ(), 0.4);
        return askPair(upper, {q, {0.005, -0.003, 0.008}}, lower, last);
      };
      PairPoints points = ask(0, 0, {});
      const std::set<std::uint32_t> kept = tests::featuresOf(points);
      ASSERT_EQ(kept.size(), 4u);
      for (int i = 0; i < 100; ++i) {
        points = ask(i, 1e-12 * std::pow(2e7, 0.01 * i), lastOf(points));
        EXPECT_EQ(tests::featuresOf(points), kept) << lower.index() << " " << upper.index() << " " << i;
      }
    }
  }
}

// The same of a mesh on a mesh, whose points are chosen by the same rule.
TEST(Manifolds, CandidatesThatWereKeptStayUntilOneIsTwiceAsGood) {
  const auto kept = [](double further, const LastPoints& last) {
    ContactCandidates candidates;
    std::uint32_t feature = 0;
    for (const Vec2& x : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1), Vec2(1.2 * further, 0.9 * further)})
      candidates.add({{Vec3(0.01 * x.x(), 0.01 * x.y(), 0), Vec3::UnitZ(), -1e-7, ++feature}});
    PairPoints out;
    candidates.keepBest(last).place(Pose{}, out);
    return out;
  };
  const LastPoints corners{Vec3::UnitZ(), {1, 2, 3, 4}, 4, 0};
  EXPECT_EQ(tests::featuresOf(kept(1, corners)), (std::set<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(tests::featuresOf(kept(1, {})).count(5), 1u);
  EXPECT_EQ(tests::featuresOf(kept(3, corners)).count(5), 1u);
}

// An open corner of a box that was twice as good took the place of the one that carried most; there the box sank by 2
// um, was pushed out, and so on for ever.
TEST(Manifolds, CandidatesThatCarriedStayUntilOneIsAHundredTimesAsGood) {
  const auto kept = [](double further, std::uint32_t carrying) {
    ContactCandidates candidates;
    std::uint32_t feature = 0;
    for (const Vec2& x : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1), Vec2(1.2 * further, 0.9 * further)})
      candidates.add({{Vec3(0.01 * x.x(), 0.01 * x.y(), 0), Vec3::UnitZ(), -1e-7, ++feature}});
    PairPoints out;
    candidates.keepBest({Vec3::UnitZ(), {1, 2, 3, 4}, 4, carrying}).place(Pose{}, out);
    return tests::featuresOf(out);
  };
  EXPECT_EQ(kept(3, 0b1111), (std::set<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(kept(60, 0b1111).count(5), 1u);
  EXPECT_EQ(kept(3, 0b1110), (std::set<std::uint32_t>{2, 3, 4, 5}));  // the one that didn't makes room
}

// Of points in a line the deepest, somewhere between the others, doesn't hide one of the two ends.
TEST(Manifolds, ALineWhoseMiddleIsDeepestKeepsBothEnds) {
  for (const double middle : {-0.004, 0.0, 0.007}) {
    ContactCandidates candidates;
    std::uint32_t feature = 0;
    for (const double x : {-0.01, -0.005, middle, 0.005, 0.01})
      candidates.add({{Vec3(x, 0, 0), Vec3::UnitZ(), x == middle ? -5e-6 : -1e-6, ++feature}});
    PairPoints out;
    candidates.keepBest().place(Pose{}, out);
    std::set<double> kept;
    for (int k = 0; k < out.count; ++k) kept.insert(out.points[static_cast<std::size_t>(k)].p_W.x());
    EXPECT_EQ(kept, (std::set<double>{-0.01, middle, 0.01})) << middle;
  }
}

TEST(Manifolds, CylinderStandsOnItsRim) {
  const Cylinder cylinder{0.024, 0.019};
  for (const Shape& table : boxAndItsMesh({0.04, 0.05, 0.02})) {
    for (const double turn : {0.0, 0.3, 2.0}) {
      const PairPoints p = askPair(cylinder, {about(Vec3::UnitZ(), turn), {0.004, -0.01, 0.039 - 1e-6}}, table);
      ASSERT_EQ(p.count, 4);
      for (int k = 0; k < p.count; ++k) {
        const Vec3& q = p.points[static_cast<std::size_t>(k)].p_W;
        EXPECT_NEAR((q.head<2>() - Vec2(0.004, -0.01)).norm(), cylinder.radius, 1e-15);
        EXPECT_NEAR(p.points[static_cast<std::size_t>(k)].phi, -1e-6, 1e-15);
      }
      // of the square in the rim
      EXPECT_GT(Outline(p, {0.004, -0.01}).area, 0.95 * 2 * cylinder.radius * cylinder.radius);
      EXPECT_TRUE(Outline(p, {0.004, -0.01}).holds);
    }
  }
}

// Expects two points, at `from` and `to`, with the gap and normal given.
void expectLine(const PairPoints& p, Vec3 from, Vec3 to, double gap, const Vec3& n, const char* what) {
  // [rad]: beside a wall's line the gap is flat, and its maximum is known to the root of round-off
  constexpr double kTurned = 2e-7;
  constexpr double kAlike = 1e-8;      // [m]: a point on a wall of 12 mm radius, turned by that
  constexpr double kRoundOff = 1e-12;  // [m]
  ASSERT_EQ(p.count, 2) << what;
  if ((p.points[0].p_W - from).norm() > (p.points[0].p_W - to).norm()) std::swap(from, to);
  EXPECT_LE((p.points[0].p_W - from).norm(), kAlike) << what;
  EXPECT_LE((p.points[1].p_W - to).norm(), kAlike) << what;
  for (const PairPoint& c : {p.points[0], p.points[1]}) {
    EXPECT_NEAR(c.phi, gap, kRoundOff) << what;
    EXPECT_LE((c.n_W - n).norm(), kTurned) << what;
  }
}

// On the top, then beyond its rim, where it is carried between an end of its own and the rim.
TEST(Manifolds, CylinderLiesOnTheEndsOfItsLine) {
  const Cylinder cylinder{0.012, 0.019};
  for (const Shape& table : boxAndItsMesh({0.04, 0.05, 0.02})) {
    for (const double gap : {1e-5, -1e-6}) {
      const Quat lying = about(Vec3::UnitY(), 0.5 * tests::kPi);
      const double z = 0.02 + 0.5 * gap;
      for (const double x : {0.003, 0.03}) {
        const PairPoints p = askPair(cylinder, {lying, {x, -0.01, 0.032 + gap}}, table);
        expectLine(p, {x - 0.019, -0.01, z}, {std::min(x + 0.019, 0.04), -0.01, z}, gap, Vec3::UnitZ(), "on top");
      }
    }
  }
}

// Cans that cross near the end of one touched at the crossing and at the end beside it, of which now one, now the other
// carried.
TEST(Manifolds, ACrossingBesideAnEndIsOnePoint) {
  const Cylinder can{0.011, 0.012};
  const Quat lying = about(Vec3::UnitY(), 0.5 * tests::kPi);
  for (const double angle : {0.01, 0.05, 0.2}) {
    for (int i = -20; i <= 20; ++i) {
      const Vec3 crossing(0.012 + 1e-6 * i, 0, 0.022), along(std::cos(angle), std::sin(angle), 0);
      // seen from the lower one, which lies along x
      const Pose X{lying.conjugate() * about(Vec3::UnitZ(), angle) * lying,
                   lying.conjugate() * (crossing + 0.003 * along)};
      const PairPoints p = askPair(can, X, can);
      ASSERT_GE(p.count, 1) << angle << " " << i;
      for (int k = 0; k < p.count; ++k) {
        for (int l = 0; l < k; ++l) EXPECT_GT((p.points[k].p_W - p.points[l].p_W).norm(), 1e-5) << angle << " " << i;
      }
    }
  }
}

// Along an edge, between the two faces' normals: what rolls over the rim of a table keeps its heading.
TEST(Manifolds, RoundBodiesAlongAnEdgeTouchItOverAllTheirLength) {
  const Vec3 half(0.04, 0.05, 0.02), n = Vec3(1, 0, 1).normalized();
  const Quat along_y = about(Vec3::UnitX(), 0.5 * tests::kPi);
  for (const Shape& table : boxAndItsMesh(half)) {
    for (const double gap : {1e-5, -1e-6}) {
      for (const double y : {0.003, 0.04}) {
        const Vec3 edge(half.x(), 0, half.z()), from = edge + 0.5 * gap * n + (y - 0.019) * Vec3::UnitY();
        const Vec3 to = edge + 0.5 * gap * n + std::min(y + 0.019, half.y()) * Vec3::UnitY();
        const Pose X{along_y, edge + (0.012 + gap) * n + y * Vec3::UnitY()};
        expectLine(askPair(Capsule{0.012, 0.019}, X, table), from, to, gap, n, "capsule");
        expectLine(askPair(Cylinder{0.012, 0.019}, X, table), from, to, gap, n, "cylinder");
      }
    }
  }
}

// 20 mm/s and 0.2 rad/s at 1 kHz.
TEST(Manifolds, KeepTheirNamesWhileTheBodySlidesAndTurns) {
  constexpr int kTicks = 500;
  forAllStanding([&](const Standing& a, const Standing& b) {
    PairPoints before;
    int points = 0, kept = 0;
    for (int i = 0; i < kTicks; ++i) {
      const Pose X_BA{about(Vec3::UnitZ(), 0.3 + 2e-4 * i), {2e-5 * i - 0.005, 0.001, b.high + a.low - 1e-6}};
      const PairPoints now = askPair(a.shape, X_BA, b.shape);
      const std::set<std::uint32_t> names = tests::featuresOf(before);
      for (int k = 0; i > 0 && k < now.count; ++k, ++points)
        kept += names.contains(now.points[static_cast<std::size_t>(k)].feature);
      before = now;
    }
    EXPECT_GT(kept, 0.98 * points) << a.name << " on " << b.name;
  });
}

// Four points on a face prove it the best direction; tilts from round-off to a degree ask where
// that ends. The oracle knows all directions.
TEST(Manifolds, OnAFaceTheLastNormalIsAsGoodAsAllDirections) {
  RandomNumbers random(4);
  int pairs = 0, compared = 0;
  forAllStanding([&](const Standing& a, const Standing& b) {
    if (isMeshShape(a.shape) || isMeshShape(b.shape)) return;
    ++pairs;
    for (int i = 0; i < 12; ++i) {
      const Vec3 axis = direction(random);
      const Quat turn = about(Vec3::UnitZ(), random.uniform(-3, 3));
      const Quat tilt = about(Vec3(axis.x(), axis.y(), 0).normalized(), std::pow(10, random.uniform(-13, -2)));
      const double gap = i % 2 == 0 ? -1e-6 : 1e-6;
      const Pose X_BA{tilt * turn, {random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), b.high + a.low + gap}};
      const PairPoints p = askPair(a.shape, X_BA, b.shape, {Vec3::UnitZ()});
      if (p.count == 0) continue;
      ++compared;
      const double mine = tasks::convexGapAlong(a.shape, X_BA, b.shape, Pose{}, p.points[0].n_W);
      const double best = tasks::convexGap(a.shape, X_BA, b.shape, Pose{}).gap;
      const bool boxes = std::holds_alternative<Box>(a.shape) && std::holds_alternative<Box>(b.shape);
      EXPECT_GE(mine, best - (boxes ? 1e-6 : 1e-9) * kStandingSize)
          << a.name << " on " << b.name << " " << i;  // as in pairs_judged_test.cpp
    }
  });
  EXPECT_GE(pairs, 9);                  // three shapes on three
  EXPECT_GE(compared, 12 * pairs - 5);  // all today
}

}  // namespace
}  // namespace pincer::contact
