// The 2D algorithm against arcs, lines and ellipses, whose contact is known, and against what must hold for any path.
#include <gtest/gtest.h>

#include <limits>

#include "pincer/contact/curve/curve.h"
#include "pincer/contact/error.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::contact {
namespace {

using tests::RandomNumbers;

constexpr double kCurveFinger = 0.02;  // [m] of the discrimination experiment
constexpr double kArcRadius = 0.1;     // [m] of its arc
const SurfaceVariant kCurveVariants[] = {SurfaceVariant::smooth, SurfaceVariant::facet, SurfaceVariant::force};

// counter-clockwise from +y
Vec2 onCircle(double radius, double angle) { return radius * Vec2(-std::sin(angle), std::cos(angle)); }
double angleOf(const Vec2& p) { return std::atan2(-p.x(), p.y()); }

CurveContact queryFresh(const Curve& curve, const Vec2& C, double r) {
  CurveTracker tracker;
  return curve.queryCircle(C, r, tracker);
}

Polyline ellipse(double a, double b, int n) {
  Polyline p{{}, true};
  for (int i = 0; i < n; ++i) p.vertices.emplace_back(a * std::cos(2 * M_PI * i / n), b * std::sin(2 * M_PI * i / n));
  return p;
}

// Closed, with hollows; no turn beyond 60 degrees.
Polyline blob(RandomNumbers& random) {
  const double depth = random.uniform(0, 0.25), phase = random.uniform(0, 6);
  const int n = 24 + random.below(40);
  Polyline p{{}, true};
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * (i + random.uniform(-0.2, 0.2)) / n;
    p.vertices.push_back(0.05 * (1 + depth * std::sin(3 * angle + phase)) * Vec2(std::cos(angle), std::sin(angle)));
  }
  return p;
}

struct Sweep {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
};

// The design's figures: five segments on 0.9 rad of a 100 mm arc. Closed forms in curve.h, with b = 0.09:
// radius R cos(b), curvature between tan(b)/b cos(b) and tan(b)/b / cos(b); the former is exact at the
// segments' middles and off by 1e-7 R between.
TEST(Curve, FiveSegmentsOnAnArcAreThatArc) {
  const double b = 0.09;
  const Curve curve(arcPolygon(kArcRadius, 2 * b, 0.9), SurfaceVariant::smooth);
  Sweep radius, curvature;
  const int n = 2000;
  const double reach = 0.9 / 2 - b;  // the outer halves of the outer segments are straight
  CurveContact last;
  for (int i = 0; i <= n; ++i) {
    const CurveContact c =
        queryFresh(curve, onCircle(kArcRadius + kCurveFinger - 0.002, reach * (2.0 * i / n - 1)), kCurveFinger);
    radius.add(c.p_BS.norm() / kArcRadius - 1);
    if (i > 0) {
      const double turned = angleOf(c.n_B) - angleOf(last.n_B), moved = (c.p_BS - last.p_BS).norm();
      curvature.add(turned / moved * kArcRadius - 1);
    }
    last = c;
  }
  EXPECT_GT(radius.least, -0.00415);
  EXPECT_LT(radius.most, -0.00395);
  EXPECT_NEAR(radius.least, std::cos(b) - 1, 2e-5);
  EXPECT_GT(curvature.least, -0.003);
  EXPECT_LT(curvature.most, 0.007);
  EXPECT_NEAR(curvature.least, std::tan(b) / b * std::cos(b) - 1, 1e-4) << "sampled over half a milliradian";
  EXPECT_NEAR(curvature.most, std::tan(b) / b / std::cos(b) - 1, 1e-4);
}

TEST(Curve, AStraightPathIsItsLine) {
  for (const SurfaceVariant variant : kCurveVariants) {
    const Curve curve({{{0.05, 0}, {0.03, 0}, {-0.01, 0}, {-0.02, 0}, {-0.06, 0}}, false}, variant);
    for (int i = 0; i <= 100; ++i) {
      const Vec2 C(-0.06 + 0.0011 * i, 0.017);
      const CurveContact c = queryFresh(curve, C, kCurveFinger);
      ASSERT_NEAR(c.p_BS.x(), C.x(), 1e-17);
      ASSERT_NEAR(c.p_BS.y(), 0, 1e-17);
      ASSERT_NEAR(c.phi, -0.003, 1e-17);
      ASSERT_NEAR(c.finger_angle, 0, 1e-15);
    }
  }
}

// Exact contact from the ellipse's parameter: twice as many segments, a quarter of the
// error (second order), in place and normal.
TEST(Curve, ConvergesToAnEllipse) {
  const double a = 0.06, b = 0.035, h = 0.015;
  double last_place = 0, last_normal = 0;
  for (const int n : {32, 64, 128}) {
    const Curve curve(ellipse(a, b, n), SurfaceVariant::smooth);
    double place = 0, normal = 0;
    for (int i = 0; i < 500; ++i) {
      const double s = 2 * M_PI * i / 500;
      const Vec2 p(a * std::cos(s), b * std::sin(s)), out = Vec2(b * std::cos(s), a * std::sin(s)).normalized();
      const CurveContact c = queryFresh(curve, p + h * out, kCurveFinger);
      place = std::max(place, (c.p_BS - p).norm());
      normal = std::max(normal, (c.n_B - out).norm());
    }
    if (last_place > 0) {
      EXPECT_NEAR(last_place / place, 4, 0.5) << n;
      EXPECT_NEAR(last_normal / normal, 4, 0.5) << n;
    }
    last_place = place;
    last_normal = normal;
  }
  EXPECT_LT(last_place, 50e-6);
}

// The equation of curve.h, by its own words: O where the bisectors meet, alpha and beta as angles about it.
TEST(Curve, TheTangentLineIsThatOfTheRadialParameter) {
  const Polyline path{{{0.1, 0}, {0.08, 0.05}, {0.02, 0.09}, {-0.03, 0.095}, {-0.08, 0.06}}, false};
  const Curve curve(path, SurfaceVariant::smooth);
  RandomNumbers random(5);
  int bends = 0;
  for (int i = 0; i < 1000; ++i) {
    CurveTracker tracker;
    const Vec2 C = random.uniform(0.1, 0.2) * Vec2(std::cos(0.003 * i), std::sin(0.003 * i));
    const CurveContact c = curve.queryCircle(C, kCurveFinger, tracker);
    ASSERT_LT((C - c.p_BS - (c.phi + kCurveFinger) * c.n_B).norm(), 1e-16);
    if (tracker.cell == 0 || tracker.cell == 4) continue;
    ++bends;
    const auto v = static_cast<std::size_t>(tracker.cell);
    const Vec2 M0 = 0.5 * (path.vertices[v - 1] + path.vertices[v]), P = path.vertices[v],
               M1 = 0.5 * (P + path.vertices[v + 1]);
    Eigen::Matrix2d lines;  // (O - M) . (P - M) = 0
    lines << (P - M0).transpose(), (P - M1).transpose();
    const Vec2 O = lines.inverse() * Vec2(M0.dot(P - M0), M1.dot(P - M1));
    const auto angle = [&](const Vec2& p) { return std::atan2((p - O).y(), (p - O).x()); };
    const double t = (angle(c.p_BS) - angle(M0)) / (angle(M1) - angle(M0));
    const Vec2 D = (1 - t) * (P - M0) + t * (M1 - P), on = (1 - t) * (1 - t) * M0 + 2 * t * (1 - t) * P + t * t * M1;
    ASSERT_NEAR(c.n_B.dot(D.normalized()), 0, 1e-13);
    ASSERT_NEAR((c.p_BS - on).dot(c.n_B), 0, 1e-15);
  }
  EXPECT_GT(bends, 500);
}

// From every vertex within a quarter of the path, and from both ends of its arc, to the same contact: also with fingers
// many times larger than the path's radius, where the plain iteration (error factor -h/R) would diverge. (From the far
// side a finger stays there: a body that is thinner than its far side's radius has a contact of its own there.)
TEST(Curve, EveryStartConverges) {
  const Curve curve(ellipse(0.02, 0.012, 24), SurfaceVariant::smooth);
  for (const double h : {0.001, 0.02, 0.5}) {
    for (int i = 0; i < 60; ++i) {
      const double s = 2 * M_PI * (i + 0.3) / 60;
      const Vec2 C = Vec2(0.02 * std::cos(s), 0.012 * std::sin(s)) +
                     h * Vec2(0.012 * std::cos(s), 0.02 * std::sin(s)).normalized();
      CurveTracker nearest;
      const CurveContact truth = curve.queryCircle(C, h + 0.001, nearest);
      for (std::int32_t k = -6; k <= 6; ++k) {
        for (const double t : {0.0, 0.37, 1.0}) {
          CurveTracker tracker{(nearest.cell + 24 + k) % 24, t};
          const CurveContact c = curve.queryCircle(C, h + 0.001, tracker);
          ASSERT_NEAR((c.p_BS - truth.p_BS).norm(), 0, 1e-15 * (1 + h / 0.001)) << h << ' ' << i << ' ' << k;
        }
      }
    }
  }
}

// Hollows tighter than the finger included: each finger finds a cell between its gates and a finite contact there.
TEST(Curve, AnyFingerOnAnyBlobFindsAContact) {
  RandomNumbers random(9);
  for (int i = 0; i < 200; ++i) {
    const Polyline path = blob(random);
    const SurfaceVariant variant = kCurveVariants[i % 3];
    const Curve curve(path, variant);
    CurveTracker tracker;
    for (int k = 0; k < 100; ++k) {
      const Vec2 C(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
      const CurveContact c = curve.queryCircle(C, random.uniform(0.001, 0.05), tracker);
      ASSERT_TRUE(c.p_BS.allFinite() && c.n_B.allFinite() && std::isfinite(c.phi));
      ASSERT_NEAR(c.n_B.norm(), 1, 1e-14);
      if (variant != SurfaceVariant::smooth) continue;
      const auto n = path.vertices.size(), v = static_cast<std::size_t>(tracker.cell);
      const auto ahead = [&](std::size_t from) {
        const Vec2 p = path.vertices[from % n], q = path.vertices[(from + 1) % n];
        return (C - 0.5 * (p + q)).dot((q - p).normalized());
      };
      ASSERT_GE(ahead(v + n - 1), -1e-16);
      ASSERT_LE(ahead(v), 1e-16);
    }
  }
}

// A finger of 8 mm over 15 degrees between segments: the facets' location jumps by r theta = 2.09 mm, force shading
// smooths the direction only, tactile shading both. Steps of 1 um.
TEST(Curve, ShadingRemovesTheJumpOnTheFinger) {
  const double r = 0.008, theta = 15 * kDegree, h = r - 0.001;
  for (const SurfaceVariant variant : kCurveVariants) {
    const Curve curve(arcPolygon(0.025, theta, 90 * kDegree), variant);
    CurveTracker tracker;
    double location = 0, direction = 0, depth = 0;
    CurveContact last;
    const int n = 30000;
    for (int i = 0; i <= n; ++i) {
      const CurveContact c = curve.queryCircle(onCircle(0.025 + h, 0.6 * (2.0 * i / n - 1)), r, tracker);
      if (i > 0) {
        location = std::max(location, r * std::abs(c.finger_angle - last.finger_angle));
        direction = std::max(direction, std::abs(angleOf(c.n_B) - angleOf(last.n_B)));
        depth = std::max(depth, std::abs(c.phi - last.phi));
      }
      last = c;
    }
    const double step = 1.2 / n;  // of the centre's angle, and of the ideal normal
    if (variant == SurfaceVariant::smooth) {
      EXPECT_LT(location, 1.02 * r * step);
      EXPECT_LT(direction, 1.02 * step);
      EXPECT_LT(depth, 1e-9) << "the finger follows the arc";
    } else {
      EXPECT_NEAR(location, r * theta, 1e-9) << "2.09 mm";
      const double largest = variant == SurfaceVariant::facet ? theta + 1e-9 : 1.4 * step;
      EXPECT_LT(direction, largest) << "theta over the segment's length, as seen from the centre";
      EXPECT_LT(depth, 1e-5);
    }
  }
}

// Morgenbesser & Srinivasan: at a quarter of a segment the direction is a quarter
// of the way between its vertices' normals.
TEST(Curve, ForceShadingInterpolatesTheNormal) {
  const double theta = 10 * kDegree;
  const Polyline arc = arcPolygon(kArcRadius, theta, 50 * kDegree);
  const Curve curve(arc, SurfaceVariant::force);
  const Vec2 a = arc.vertices[2], b = arc.vertices[3], n = (a + b).normalized();
  for (const double s : {0.0, 0.25, 0.5, 0.9}) {
    const Vec2 foot = (1 - s) * a + s * b;
    const CurveContact c = queryFresh(curve, foot + 0.019 * n, kCurveFinger);
    EXPECT_LT((c.p_BS - foot).norm(), 1e-15);
    EXPECT_NEAR(c.phi, -0.001, 1e-15) << "depth of the flat segment";
    EXPECT_LT((c.n_B - ((1 - s) * a + s * b).normalized()).norm(), 1e-14) << "the vertices' normals are radial here";
    EXPECT_NEAR(c.finger_angle, angleOf(n), 1e-14) << "location of the flat segment";
  }
}

// Contact point and normal move by at most so much per movement of the centre, over
// vertices, segments' middles and ends alike.
TEST(Curve, IsContinuousAcrossVerticesAndEnds) {
  const Curve curve({{{0.1, 0}, {0.08, 0.05}, {0.02, 0.09}, {-0.03, 0.095}, {-0.08, 0.06}}, false},
                    SurfaceVariant::smooth);
  CurveTracker tracker;
  const int n = 200000;
  const double step = 0.11 * 4 / n, h = 0.01;
  CurveContact last;
  for (int i = 0; i <= n; ++i) {
    const CurveContact c =
        curve.queryCircle(0.11 * Vec2(std::cos(-0.5 + 4.0 * i / n), std::sin(-0.5 + 4.0 * i / n)), 0.012, tracker);
    if (i > 0) {
      ASSERT_LT((c.p_BS - last.p_BS).norm(), 1.2 * step) << i;
      // rolling over an end: 1 / h, h >= 3 mm on this path
      ASSERT_LT((c.n_B - last.n_B).norm(), 1.05 * step / (h * 0.3)) << i;
    }
    last = c;
  }
}

// Back along the same path to the same contacts, tracked or not.
TEST(Curve, ReversingTheFingersPathReversesTheContact) {
  RandomNumbers random(3);
  const Curve curve(ellipse(0.05, 0.03, 40), SurfaceVariant::smooth);
  std::vector<Vec2> path;
  for (int i = 0; i < 500; ++i) path.push_back(Vec2(0.06 * std::cos(0.01 * i), 0.04 * std::sin(0.01 * i)));
  CurveTracker tracker;
  std::vector<CurveContact> there;
  for (const Vec2& C : path) there.push_back(curve.queryCircle(C, 0.013, tracker));
  for (std::size_t i = path.size(); i-- > 0;) {
    const CurveContact back = curve.queryCircle(path[i], 0.013, tracker);
    ASSERT_LT((back.p_BS - there[i].p_BS).norm(), 1e-15);
    ASSERT_LT((queryFresh(curve, path[i], 0.013).p_BS - there[i].p_BS).norm(), 1e-15);
  }
}

// A rotated, moved and scaled world gives the rotated, moved and scaled contact, over six decades of scale.
TEST(Curve, KnowsNoPlaceDirectionOrScale) {
  RandomNumbers random(4);
  for (int i = 0; i < 300; ++i) {
    const Polyline path = blob(random);
    const SurfaceVariant variant = kCurveVariants[i % 3];
    const double angle = random.uniform(0, 6.28), scale = std::pow(10.0, random.uniform(-3, 3));
    const Eigen::Rotation2Dd R(angle);
    const Vec2 shift = 0.1 * Vec2{random.uniform(-1, 1), random.uniform(-1, 1)};
    Polyline moved{{}, true};
    for (const Vec2& p : path.vertices) moved.vertices.push_back(scale * (R * p + shift));
    const Curve a(path, variant), b(moved, variant);
    const Vec2 C = random.uniform(0.065, 0.09) * Vec2(std::cos(angle + i), std::sin(angle + i));
    const CurveContact ca = queryFresh(a, C, 0.01), cb = queryFresh(b, scale * (R * C + shift), scale * 0.01);
    ASSERT_LT((cb.p_BS / scale - (R * ca.p_BS + shift)).norm(), 1e-13) << i;
    ASSERT_LT((cb.n_B - R * ca.n_B).norm(), 1e-12);
    ASSERT_NEAR(cb.phi / scale, ca.phi, 1e-14);
  }
}

// Seen in a mirror, and walked the other way so that the body stays on the left.
TEST(Curve, AMirroredPathGivesTheMirroredContact) {
  RandomNumbers random(6);
  for (int i = 0; i < 300; ++i) {
    const Polyline path = blob(random);
    Polyline mirrored{{}, true};
    for (std::size_t k = path.vertices.size(); k-- > 0;)
      mirrored.vertices.emplace_back(-path.vertices[k].x(), path.vertices[k].y());
    const Curve a(path, SurfaceVariant::smooth), b(mirrored, SurfaceVariant::smooth);
    const Vec2 C = random.uniform(0.065, 0.09) * Vec2(std::cos(i), std::sin(i));
    const CurveContact ca = queryFresh(a, C, 0.01), cb = queryFresh(b, {-C.x(), C.y()}, 0.01);
    ASSERT_LT((cb.p_BS - Vec2(-ca.p_BS.x(), ca.p_BS.y())).norm(), 1e-13) << i;
    ASSERT_NEAR(cb.finger_angle, -ca.finger_angle, 1e-11);
  }
}

// Free space: the nearer leg of a U takes over. In contact: the leg that is touched is
// followed, though the other is pressed deeper.
TEST(Curve, FollowsInContactAndSearchesInFreeSpace) {
  const Polyline u{{{0.02, 0.1}, {0.02, 0}, {-0.02, 0}, {-0.02, 0.1}}, false};  // body outside, the hollow within
  const Curve curve(u, SurfaceVariant::facet);
  CurveTracker tracker;
  EXPECT_EQ(curve.queryCircle({-0.01, 0.05}, 0.005, tracker).n_B, Vec2(1, 0)) << "left leg";
  EXPECT_EQ(curve.queryCircle({0.01, 0.05}, 0.005, tracker).n_B, Vec2(-1, 0));
  EXPECT_EQ(tracker.cell, 0);
  EXPECT_EQ(curve.queryCircle({0.0, 0.05}, 0.025, tracker).n_B, Vec2(-1, 0));
  EXPECT_EQ(curve.queryCircle({-0.01, 0.05}, 0.035, tracker).n_B, Vec2(-1, 0));
}

TEST(Curve, RefusesTheVariantThatExistsForMeshesOnly) {
  EXPECT_THROW(Curve({{{0, 0}, {1, 0}}, false}, SurfaceVariant::smooth_published), InputError);
  EXPECT_THROW(Curve({{{0, 0}, {1, 0}, {1, 1}}, false}, SurfaceVariant::smooth), InputError)
      << "a right angle is no smooth curve";
  EXPECT_NO_THROW(Curve({{{0, 0}, {1, 0}, {1, 1}}, false}, SurfaceVariant::facet));
}

// Vertices named twice are sharp: a square so named has the distance of a square everywhere outside, and
// its corners push straight away from them.
TEST(Curve, CornersNamedTwiceAreSharp) {
  Polyline square{{}, true};
  for (const Vec2& p : {Vec2(-0.03, -0.03), Vec2(0.03, -0.03), Vec2(0.03, 0.03), Vec2(-0.03, 0.03)}) {
    square.vertices.push_back(p);
    square.vertices.push_back(p);
  }
  const Curve curve(square, SurfaceVariant::smooth);
  RandomNumbers random(3);
  int outside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec2 C(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
    if (C.cwiseAbs().maxCoeff() < 0.031) continue;
    ++outside;
    const Vec2 away = C - C.cwiseMax(-0.03).cwiseMin(0.03);
    const CurveContact found = queryFresh(curve, C, 0.005);
    EXPECT_NEAR(found.phi, away.norm() - 0.005, 1e-15);
    EXPECT_LT((found.n_B - away.normalized()).norm(), 1e-12);
  }
  EXPECT_GE(outside, 400);  // 452 of these places
}

// The published edge: 2 degrees between its faces. A finger that goes round it stays
// on it, and its contact turns as it does.
TEST(Curve, AFingerGoesRoundASharpEdge) {
  const double half = kDegree;
  const Vec2 down = 0.03 * Vec2(std::sin(half), -std::cos(half));
  const Curve blade({{down, Vec2::Zero(), Vec2::Zero(), Vec2(-down.x(), down.y())}, false}, SurfaceVariant::smooth);
  CurveTracker tracker;
  for (int k = -60; k <= 60; ++k) {
    const double a = k * kDegree;
    const CurveContact found = blade.queryCircle(onCircle(0.0129, a), 0.013, tracker);
    EXPECT_LT(found.p_BS.norm(), 1e-15);
    EXPECT_NEAR(found.phi, -1e-4, 1e-15);
    EXPECT_NEAR(found.finger_angle, a, 1e-12);
  }
}

// In a sharp hollow the nearer side counts, and from one to the other the depth goes on.
TEST(Curve, TheNearerSideOfASharpHollowCounts) {
  const Curve hollow({{Vec2(0.1, 0.1), Vec2::Zero(), Vec2::Zero(), Vec2(-0.1, 0.1)}, false}, SurfaceVariant::smooth);
  const double side = std::sqrt(0.5);
  EXPECT_NEAR(queryFresh(hollow, {0.001, 0.05}, 0.01).phi, side * 0.049 - 0.01, 1e-15);
  EXPECT_NEAR(queryFresh(hollow, {-0.001, 0.05}, 0.01).phi, side * 0.049 - 0.01, 1e-15);
  EXPECT_GT(queryFresh(hollow, {-0.001, 0.05}, 0.01).n_B.x(), 0);
}

TEST(Curve, AllocatesNothing) {
  if (!pincer::tests::allocationsAreCounted()) GTEST_SKIP() << "this build can't count allocations";
  const Curve curve(ellipse(0.05, 0.03, 40), SurfaceVariant::smooth);
  CurveTracker tracker;
  const std::int64_t before = pincer::tests::allocationCount();
  for (int i = 0; i < 200; ++i) curve.queryCircle(0.06 * Vec2(std::cos(i), std::sin(i)), 0.02, tracker);
  EXPECT_EQ(pincer::tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::contact
