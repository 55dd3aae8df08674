// Fingertips of any convex shape: their support functions, and where they touch, against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "pincer/contact/finger_query.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/shape/closed_forms.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::contact {
namespace {

using tests::RandomNumbers;

// A pad like a fingertip's underside: a flattened cap of 60 points.
PadTip padTip() {
  RandomNumbers random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < 60; ++i) {
    const Vec3 d = tests::direction(random);
    points.push_back(Vec3(9e-3 * d.x(), 7e-3 * d.y(), 4e-3 * d.z()));
  }
  return {Polytope::hullOf(points, "pad"), 1e-3};
}

std::vector<FingerShape> allTips() {
  return {Sphere{8e-3}, CapsuleTip{5e-3, Vec3(8e-3, 0, 2e-3)}, EllipsoidTip{Vec3(10e-3, 7e-3, 6e-3)}, padTip()};
}

std::vector<Shape> smoothBodies() {
  return {Sphere{0.02}, HalfSpace{}, Capsule{0.015, 0.02}, Cylinder{0.02, 0.03}, Box{Vec3(0.02, 0.03, 0.025)}};
}

double bodyDistance(const Shape& shape, const Vec3& p_B) {
  SurfaceTracker tracker;
  static PatchCache cache(1);  // smooth bodies have no patches
  const double r = 1e-3;
  return querySphere(shape, p_B, r, 0, tracker, cache).main().phi + r;
}

// Least distance of the core to the body by brute force: everywhere on the core's skin, then
// closer and closer around the best places.
double leastGapByBruteForce(const Shape& shape, const FingerShape& finger, const Pose& X_BF, RandomNumbers& random) {
  struct Place {
    double d;
    Vec3 direction;
  };
  const auto at = [&](const Vec3& direction) {
    return Place{bodyDistance(shape, X_BF * coreSupportOf(finger, direction)), direction};
  };
  std::vector<Place> best;
  for (int i = 0; i < 2000; ++i) best.push_back(at(tests::direction(random)));
  std::sort(best.begin(), best.end(), [](const Place& a, const Place& b) { return a.d < b.d; });
  best.resize(5);
  for (Place& place : best) {
    for (double reach = 0.3; reach > 1e-7; reach *= 0.8) {
      for (int i = 0; i < 12; ++i) {
        const Place next = at((place.direction + reach * tests::direction(random)).normalized());
        if (next.d < place.d) place = next;
      }
    }
  }
  double least = kInfinity;
  for (const Place& place : best) least = std::min(least, place.d);
  // Between the support points of a core with edges: everywhere on the segments from the best to the others.
  for (const Place& a : best) {
    for (const Vec3& b :
         {coreSupportOf(finger, -a.direction), coreSupportOf(finger, (a.direction + Vec3(1, 0, 0)).normalized())}) {
      const Vec3 from = coreSupportOf(finger, a.direction);
      for (int i = 0; i <= 400; ++i)
        least = std::min(least, bodyDistance(shape, X_BF * (from + i / 400.0 * (b - from))));
    }
  }
  return least - roundingOf(finger);
}

TEST(FingerShape, SupportPointsAreTheFurthestOnes) {
  RandomNumbers random(3);
  for (const FingerShape& finger : allTips()) {
    std::vector<Vec3> skin;
    for (int i = 0; i < 500; ++i) skin.push_back(supportOf(finger, tests::direction(random)));
    for (int i = 0; i < 50; ++i) {
      const Vec3 d = tests::direction(random), s = supportOf(finger, d);
      for (const Vec3& p : skin) EXPECT_GE(s.dot(d), p.dot(d) - 1e-15);
      EXPECT_LE(s.norm(), boundingRadiusOf(finger) * (1 + 1e-12));
    }
  }
}

TEST(FingerShape, EllipsoidIsItsCoreAndABall) {
  RandomNumbers random(4);
  const Vec3 a(10e-3, 7e-3, 6e-3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 s = supportOf(EllipsoidTip{a}, tests::direction(random));
    EXPECT_NEAR(s.cwiseQuotient(a).squaredNorm(), 1, 1e-14);
    // nearest point of the core to a place outside: no sampled core point is nearer
    const Vec3 p = 0.03 * tests::direction(random), c = nearestOnCore(EllipsoidTip{a}, p, p.normalized());
    for (int k = 0; k < 100; ++k) {
      EXPECT_GE((coreSupportOf(EllipsoidTip{a}, tests::direction(random)) - p).norm(), (c - p).norm() - 1e-15);
    }
  }
}

TEST(FingerShape, TouchesWhereBruteForceFindsIt) {
  RandomNumbers random(5);
  int queries = 0, count = 0;
  for (const FingerShape& finger : allTips()) {
    for (const Shape& shape : smoothBodies()) {
      for (int i = 0; i < tests::draws(4); ++i) {
        const bool plane = std::holds_alternative<HalfSpace>(shape);
        const Vec3 d = plane ? Vec3::UnitZ() : tests::direction(random);
        Pose X_BF{tests::rotation(random), (plane ? 0.012 : 0.045) * d};
        FingerTracker tracker;
        PatchCache cache(8);
        FingerContacts found = queryFinger(shape, finger, X_BF, 1e-3, tracker, cache);
        // from a little inside to a little outside
        X_BF.p += (random.uniform(-1e-3, 2e-3) - found.main().phi) * found.main().n_B;
        tracker = {};
        found = queryFinger(shape, finger, X_BF, 1e-3, tracker, cache);
        queries += found.queries;
        ++count;
        const double brute = leastGapByBruteForce(shape, finger, X_BF, random);
        EXPECT_LT(found.main().phi, brute + 1e-9) << finger.index() << " " << shape.index();
        // of faces and edges the sampling knows only corners; it is a point of the core
        if (const auto* pad = std::get_if<PadTip>(&finger)) {
          const Vec3 c_F = X_BF.inverse() * found.p_BT[0] + pad->rounding * (X_BF.q.conjugate() * found.main().n_B);
          EXPECT_LT(nearestPoint(Convex{pad->hull}, c_F).distance, 1e-12);
        } else {
          EXPECT_GT(found.main().phi, brute - 2e-6) << finger.index() << " " << shape.index();  // the search's grid
        }
        // what is solved: the finger's support point over S
        const Vec3 N_F = X_BF.q.conjugate() * found.main().n_B, p_F = X_BF.inverse() * found.p_BT[0];
        EXPECT_LT(N_F.dot(p_F - supportOf(finger, -N_F)), 1e-9);
      }
    }
  }
  EXPECT_LT(queries, 12 * count);
}

TEST(FingerShape, WarmQueriesTakeFewBalls) {
  RandomNumbers random(6);
  const Shape body = Sphere{0.02};
  for (const FingerShape& finger : allTips()) {
    FingerTracker tracker;
    PatchCache cache(8);
    int queries = 0;
    for (int i = 0; i < 200; ++i) {  // 100 mm/s around the ball, turning at 2 rad/s
      const double a = 1e-4 / 0.03 * i;
      const Pose X_BF{tests::about(Vec3(1, 2, 3), 2e-3 * i), 0.027 * Vec3(std::cos(a), std::sin(a), 0.1)};
      queries += queryFinger(body, finger, X_BF, 1e-3, tracker, cache).queries;
    }
    EXPECT_LT(queries, 200 * 6) << finger.index();
  }
}

TEST(FingerShape, SphereIsTheSphereQueryToTheBit) {
  const Shape body = Cylinder{0.02, 0.03};
  FingerTracker tracker;
  SurfaceTracker plain;
  PatchCache cache(8);
  const Pose X_BF{tests::about(Vec3(1, 0, 0), 0.3), Vec3(0.02, 0.015, 0.01)};
  const FingerContacts found = queryFinger(body, Sphere{8e-3}, X_BF, 1e-3, tracker, cache);
  const SurfaceContact s = querySphere(body, X_BF.p, 8e-3, 1e-3, plain, cache).main();
  EXPECT_EQ(found.main().p_BS, s.p_BS);
  EXPECT_EQ(found.main().n_B, s.n_B);
  EXPECT_EQ(found.main().phi, s.phi);
  EXPECT_EQ(found.queries, 1);
}

TEST(FingerShape, CapsuleThatLiesFlatTouchesWithBothEnds) {
  FingerTracker tracker;
  PatchCache cache(8);
  const FingerContacts found = queryFinger(HalfSpace{}, CapsuleTip{5e-3, Vec3(8e-3, 0, 0)},
                                           {Quat::Identity(), Vec3(0, 0, 4.5e-3)}, 1e-3, tracker, cache);
  ASSERT_EQ(found.count, 3);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found.points[static_cast<std::size_t>(i)].phi, -0.5e-3, 1e-15);
  EXPECT_NEAR(found.p_BT[1].x(), -8e-3, 1e-15);
  EXPECT_NEAR(found.p_BT[2].x(), 8e-3, 1e-15);
}

// The smooth surface of a mesh of 40 mm: as on the sphere that it stands for, but for
// the mesh's own 3 um (docs/benchmarks.md).
// Between its own ends it touched at one place: a rod that was shorter than the tip wobbled about that.
TEST(FingerShape, CapsuleThatIsLongerThanWhatItHoldsTouchesWithBothEndsOfThat) {
  FingerTracker tracker;
  PatchCache cache(1);
  const Pose X_BF{tests::about(Vec3(1, 0, 0), 1e-3), Vec3(0, 0, 0.015 + 0.005 - 1e-5)};
  const Shape rod = Capsule{0.015, 0.01}, lying = Cylinder{0.015, 0.01}, bar = Box{Vec3(0.015, 0.01, 0.015)};
  for (const Shape& body : {rod, lying, bar}) {
    const bool is_bar = std::holds_alternative<Box>(body);
    const Pose X_WB{is_bar ? Quat::Identity() : tests::about(Vec3(1, 0, 0), M_PI / 2), Vec3::Zero()};
    const FingerContacts found =
        queryFinger(body, CapsuleTip{0.005, Vec3(0, 0.02, 0)}, X_WB.inverse() * X_BF, 1e-3, tracker = {}, cache);
    ASSERT_EQ(found.count, 2);
    EXPECT_NEAR((found.points[0].p_BS - found.points[1].p_BS).norm(), 0.02, 1e-4);
    EXPECT_NEAR(found.points[1].phi - found.points[0].phi, 0.02 * 1e-3, 1e-7);
  }
}

TEST(FingerShape, FeelsTheSmoothSurfaceOfAMesh) {
  RandomNumbers random(8);
  const Shape mesh = Mesh{SmoothMesh::build(icosphere(0.04, 3))}, ball = Sphere{0.04};
  for (const FingerShape& finger : allTips()) {
    FingerTracker on_mesh, on_ball;
    PatchCache cache(1024);
    for (int i = 0; i < 100; ++i) {
      const double a = 2e-3 * i;
      const Pose X_BF{tests::about(Vec3(1, 2, 3), 1e-3 * i), 0.045 * Vec3(std::cos(a), std::sin(a), 0.2).normalized()};
      const FingerContacts found = queryFinger(mesh, finger, X_BF, 1e-3, on_mesh, cache);
      const FingerContacts exact = queryFinger(ball, finger, X_BF, 1e-3, on_ball, cache);
      EXPECT_NEAR(found.main().phi, exact.main().phi, 10e-6) << finger.index();
      EXPECT_LT(angleBetween(found.main().n_B, exact.main().n_B), 0.02) << finger.index();
    }
  }
}

TEST(FingerShape, ArcOverTheSkin) {
  const Vec3 down(0, 0, -1), slant = Vec3(std::sin(0.7), 0, -std::cos(0.7));
  EXPECT_DOUBLE_EQ(arcOverSkin(Sphere{8e-3}, down, slant, 8e-3 * slant), 8e-3 * 0.7);
  // an ellipse's arc in the x-z plane, integrated finely
  const EllipsoidTip tip{Vec3(10e-3, 7e-3, 6e-3)};
  double arc = 0;
  Vec3 last = supportOf(tip, down);
  for (int i = 1; i <= 20000; ++i) {
    const double a = 0.7 * i / 20000;
    const Vec3 next = supportOf(tip, Vec3(std::sin(a), 0, -std::cos(a)));
    arc += (next - last).norm();
    last = next;
  }
  EXPECT_NEAR(arcOverSkin(tip, down, slant, supportOf(tip, slant)), arc, 1e-4 * arc);
  // a capsule: the flat way to the end, then round it
  const CapsuleTip capsule{5e-3, Vec3(8e-3, 0, 0)};
  EXPECT_NEAR(arcOverSkin(capsule, Vec3(1e-9, 0, -1).normalized(), slant, Vec3(8e-3, 0, 0) + 5e-3 * slant), 5e-3 * 0.7,
              1e-6);
}

TEST(FingerShape, ProblemsAreNamed) {
  EXPECT_NE(problemWith(Sphere{0}).find("radius = 0 is out of range"), std::string::npos);
  EXPECT_NE(problemWith(EllipsoidTip{Vec3(0.1, 0.001, 0.01)}).find("ten times"), std::string::npos);
  EXPECT_EQ(problemWith(padTip()), "");
}

// A pad with flat faces, 20 x 20 x 4 mm with its rounding.
PadTip flatPad() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 9.5e-3 : -9.5e-3, i & 2 ? 9.5e-3 : -9.5e-3, i & 4 ? 1.5e-3 : -1.5e-3});
  return {Polytope::hullOf(corners, "pad"), 5e-4};
}

FingerContacts padOn(const Shape& body, const Pose& X_BF) {
  FingerTracker tracker;
  PatchCache cache(64);
  return queryFinger(body, flatPad(), X_BF, 1e-3, tracker, cache);
}

// The facets' overlap: of a smaller box its own corners, of a larger one the pad's
// core; all at the gap that the pose says.
TEST(FlatPad, TouchesFlatShapesWithTheCornersOfWhatTheyShare) {
  const double gap = -1e-5;
  const auto corners = [&](const Shape& body, double top, double x, double y) {
    const FingerContacts found = padOn(body, {Quat::Identity(), Vec3(0, 0, top + 2e-3 + gap)});
    ASSERT_EQ(found.count, 4) << body.index();
    double sum_x = 0, sum_y = 0;
    for (int i = 0; i < 4; ++i) {
      const SurfaceContact& c = found.points[static_cast<std::size_t>(i)];
      EXPECT_NEAR(c.phi, gap, 1e-15);  // sums of lengths of 0.1 m
      EXPECT_LT((c.n_B - Vec3::UnitZ()).norm(), 1e-15);
      EXPECT_NEAR(std::abs(c.p_BS.x()), x, 1e-12);
      EXPECT_NEAR(std::abs(c.p_BS.y()), y, 1e-12);
      EXPECT_NEAR(c.p_BS.z(), top, 1e-15);
      sum_x += c.p_BS.x();
      sum_y += c.p_BS.y();
    }
    EXPECT_NEAR(sum_x, 0, 1e-12);
    EXPECT_NEAR(sum_y, 0, 1e-12);
  };
  corners(Box{Vec3(0.02, 0.03, 0.01)}, 0.01, 9.5e-3, 9.5e-3);
  corners(Box{Vec3(0.005, 0.03, 0.01)}, 0.01, 5e-3, 9.5e-3);
  corners(Box{Vec3(0.005, 0.004, 0.01)}, 0.01, 5e-3, 4e-3);
  corners(HalfSpace{}, 0, 9.5e-3, 9.5e-3);
}

// A rod that lies across: the two ends of the line that it shares with the pad.
TEST(FlatPad, TouchesARodAlongALine) {
  const Pose X_BF{tests::about(Vec3(1, 0, 0), M_PI / 2), Vec3(0, -(5e-3 + 2e-3 - 1e-5), 0)};
  const FingerContacts found = padOn(Capsule{5e-3, 0.03}, X_BF);
  ASSERT_EQ(found.count, 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.points[static_cast<std::size_t>(i)].phi, -1e-5, 1e-12);
    EXPECT_NEAR(std::abs(found.points[static_cast<std::size_t>(i)].p_BS.z()), 9.5e-3, 1e-9);
  }
}

TEST(FlatPad, KeepsItsPointsWhileItTiltsAndSlides) {
  const Shape box = Box{Vec3(0.02, 0.03, 0.01)};
  FingerTracker tracker;
  PatchCache cache(8);
  std::array<std::uint32_t, 4> first{};
  for (int i = 0; i < 100; ++i) {
    const Pose X_BF{tests::about(Vec3(1, 0.3, 0), 1e-5 * i), Vec3(1e-5 * i, 2e-5 * i, 0.012)};
    const FingerContacts found = queryFinger(box, flatPad(), X_BF, 1e-3, tracker, cache);
    ASSERT_EQ(found.count, 4);
    std::array<std::uint32_t, 4> names{};
    for (std::size_t k = 0; k < 4; ++k) names[k] = found.points[k].feature;
    std::sort(names.begin(), names.end());
    if (i == 0) first = names;
    EXPECT_EQ(names, first) << i;
  }
}

}  // namespace
}  // namespace pincer::contact

namespace pincer::grasp {
namespace {

// Two ellipsoids hold a ball: no creep, and each contact's place is where its pad looks.
TEST(FingerShape, EllipsoidsHoldABall) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.05, {0.6, 0.6, 0, 3e-3}});
  std::vector<FingerModel> fingers = {tests::softFinger("left"), tests::softFinger("right")};
  for (FingerModel& f : fingers) f.shape = contact::EllipsoidTip{Vec3(10e-3, 8e-3, 7e-3)};
  const GraspModel model = buildGrasp(builder, fingers);
  GraspState state = makeState(model, {tests::startAt(Vec3(0, 0, 0.1))}, {Vec3(-0.03, 0, 0.1), Vec3(0.03, 0, 0.1)});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(2);
  for (int i = 0; i < 2; ++i) inputs[i].p_WF = Vec3(i == 0 ? -0.028 : 0.028, 0, 0.1);
  for (int i = 0; i < 500; ++i) step(model, state, scratch, inputs);
  const double z = state.world.bodies[0].X_WI.p.z();
  for (int i = 0; i < 500; ++i) step(model, state, scratch, inputs);
  EXPECT_LT(std::abs(state.world.bodies[0].X_WI.p.z() - z), 1e-9);
  EXPECT_TRUE(scratch.fingers[0].touching);
  EXPECT_NEAR(scratch.fingers[0].n_W.x(), -1, 0.01);
  // The pad looks down (-z of F); the touch is a quarter of the way round, on the side towards +x: distal.
  EXPECT_GT(placeOnPad(model.fingers[0], scratch.fingers[0].touch).x(), 0.008);
}

// A box between flat pads, 18 times what holds it, nudged: it buzzed and fell after 7
// s when each pad touched it at one point.
TEST(FlatPad, HoldsANudgedBox) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"box", contact::Box{Vec3(0.015, 0.02, 0.025)}, true, 0.1, {0.6, 0.6, 0, 0}});
  std::vector<FingerModel> fingers = {tests::softFinger("left", 5000), tests::softFinger("right", 5000)};
  for (FingerModel& f : fingers) f.shape = contact::flatPad();
  const GraspModel model = buildGrasp(builder, fingers);
  GraspState state = makeState(model, {tests::startAt(Vec3(0, 0, 0.1), Vec3::Zero(), Vec3(0, 0.3, 0))},
                               {Vec3(-0.017, 0, 0.1), Vec3(0.017, 0, 0.1)});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(2);
  for (int i = 0; i < 2; ++i) inputs[i].p_WF = Vec3(i == 0 ? -0.014 : 0.014, 0, 0.1);
  for (int i = 0; i < 1000; ++i) step(model, state, scratch, inputs);
  const Pose held = state.world.bodies[0].X_WI;
  for (int i = 0; i < 9000; ++i) EXPECT_EQ(step(model, state, scratch, inputs).status, engine::kStepOk);
  EXPECT_LT((state.world.bodies[0].X_WI.p - held.p).norm(), 1e-12);
  EXPECT_LT(angleBetween(state.world.bodies[0].X_WI.q, held.q), 1e-9);
  EXPECT_NEAR(state.world.bodies[0].X_WI.q.w(), 1, 1e-9);
}

// More bodies than pairs are looked at one by one: what is out of reach changes nothing, to the bit.
TEST(ManyFingers, FeelTheSameWithFarBodiesAround) {
  const auto run = [](int others) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {0.5, 0.5, 0, 0}});
    std::vector<engine::BodyStart> starts = {tests::startAt(Vec3(0, 0, 0.1))};
    for (int i = 0; i < others; ++i) {
      builder.addBody({"other" + std::to_string(i), contact::Sphere{0.02}, true, 0.1, {0.5, 0.5, 0, 0}});
      starts.push_back(tests::startAt(Vec3(0.5 + 0.1 * i, 0, 0.1)));
    }
    const GraspModel model = buildGrasp(builder, {tests::softFinger("left"), tests::softFinger("right")});
    GraspState state = makeState(model, starts, {Vec3(-0.028, 0, 0.1), Vec3(0.028, 0, 0.1)});
    GraspScratch scratch(model);
    std::vector<FingerInput> inputs(2);
    for (int i = 0; i < 2; ++i) inputs[i].p_WF = Vec3(i == 0 ? -0.026 : 0.026, 0, 0.1);
    for (int i = 0; i < 300; ++i) step(model, state, scratch, inputs);
    EXPECT_TRUE(scratch.fingers[0].touching && scratch.fingers[1].touching);
    return state.world.bodies[0].X_WI.p;
  };
  EXPECT_EQ(run(0), run(engine::kAllPairsBodies + 4));
}

}  // namespace
}  // namespace pincer::grasp
