// Fingers on bodies: action and reaction, holding, slipping, the pad.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/step.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

using tests::GraspWorld;
using tests::pinchedBall;
using tests::squeezing;

// Sum of the impulses on each side of every contact, as the step handed them out.
TEST(GraspStep, ActionEqualsReactionToTheLastBitEveryTick) {
  GraspWorld w = pinchedBall(0.075, 0.6);
  GraspScratch scratch(w.model);
  for (int i = 0; i < 2000; ++i) {
    auto inputs = squeezing(2e-3, 1e-3 * std::sin(0.01 * i));
    inputs[0].p_WF.y() += 5e-4 * std::sin(0.03 * i);
    step(w.model, w.state, scratch, inputs);
    Vec3 on_ball = Vec3::Zero();
    for (const engine::Contact& c : scratch.world.contacts) {
      if (c.active()) on_ball += -c.impulse_W;
    }
    EXPECT_EQ(scratch.world.bodies[0].impulse_W, on_ball);
    for (int f = 0; f < 2; ++f) {
      EXPECT_EQ(scratch.world.points[f].impulse_W / 1e-3, scratch.fingers[f].f_contact_W);
      // the proxy has no mass: all of it reaches the user
      EXPECT_EQ(scratch.fingers[f].f_user_W, scratch.fingers[f].f_contact_W);
    }
  }
  EXPECT_GT(scratch.fingers[0].normal_force, 0.5);
}

// A body that turns far under its contacts is followed in parts, whatever happened before: how fast it would turn
// was taken from the inverse inertia of its last impact, none for a body that never had one, so that a restored
// snapshot took other parts than its original.
TEST(GraspStep, NeedleStruckAtItsTipIsFollowedInParts) {
  engine::WorldOptions options;
  options.gravity_W.setZero();
  engine::WorldBuilder builder{options};
  const double half_length = 0.01, half_width = 1e-3, tip = 8e-3;
  builder.addBody({"needle", contact::Box{Vec3(half_width, half_length, half_width)}, true, 1e-3, {}});
  FingerModel finger = tests::softFinger("finger", 1000, 1);
  finger.radius = tip;
  const GraspModel model = buildGrasp(builder, {finger});
  const Vec3 p_WF(-half_width - tip, 0.8 * half_length, 0);
  GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {p_WF});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(1);
  inputs[0].p_WF = p_WF;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(step(model, state, scratch, inputs).parts, 1);
  // the tip follows at some 20 m/s, and the needle would turn by more than 1 rad in the tick
  inputs[0].p_WF.x() += 0.04;
  EXPECT_GT(step(model, state, scratch, inputs).parts, 1);
  EXPECT_GT(engine::bodyAngularVelocity(model.world, state.world, 0).norm() * options.h, 0.5);
}

// Where neither side can move there is nothing to solve; the islands once read outside their arrays there.
TEST(GraspStep, ALockedFingerMayPressOnWhatNeverMoves) {
  engine::WorldBuilder builder(engine::WorldOptions{});
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  std::vector<FingerModel> fingers(1);
  fingers[0].name = "index";
  fingers[0].coupling.locked.setConstant(true);
  const GraspModel model = buildGrasp(builder, fingers);
  const Vec3 pressed(0, 0, 0.005);  // 3 mm deep
  GraspState state = makeState(model, {{}}, {pressed});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(1);
  inputs[0].p_WF = pressed;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(step(model, state, scratch, inputs).status, engine::kStepOk);
  EXPECT_EQ(state.world.points[0].p_W, pressed);
}

// A box that begins 5 mm deep in the floor rises towards the third finger, 20 um above it; a
// pebble of radius `pebble` lies far away.
Pose pushedOutBesideAFinger(double pebble) {
  engine::WorldBuilder builder(engine::WorldOptions{});
  builder.addBody({"box", contact::Box{Vec3(0.02, 0.02, 0.02)}, true, 0.1, {}});
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"pebble", contact::Sphere{pebble}, false, 0, {}});
  std::vector<FingerModel> fingers;
  for (const char* name : {"thumb", "index", "middle"}) fingers.push_back(tests::softFinger(name, 1000, 1));
  const GraspModel model = buildGrasp(builder, fingers);
  const Vec3 p_WF(0, 0, 0.035 + fingers[2].radius + 2e-5);
  engine::BodyStart box = tests::startAt({0, 0, 0.015});
  box.v_W = Vec3(0, 0, 0.05);
  GraspState state = makeState(model, {box, tests::startAt(Vec3::Zero()), tests::startAt({1, 0, 1})},
                               {Vec3(-0.5, 0, 0.1), Vec3(-0.6, 0, 0.1), p_WF});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(3);
  for (std::size_t i = 0; i < 3; ++i) inputs[i].p_WF = state.world.points[i].p_W;
  step(model, state, scratch, inputs);
  EXPECT_TRUE(scratch.fingers[2].touching);
  return state.world.bodies[0].X_WI;
}

// Where a body was pushed out of an overlap, the number of a finger that touched it was taken for a body's, for its
// thickness: what happened depended on a body elsewhere, or on what lay behind the last one.
TEST(GraspStep, APebbleElsewhereDoesNotChangeHowABodyIsPushedOutBesideAFinger) {
  const Pose thin = pushedOutBesideAFinger(1e-6), thick = pushedOutBesideAFinger(0.05);
  EXPECT_EQ(thin.p, thick.p);
  EXPECT_EQ(thin.q.coeffs(), thick.q.coeffs());
}

TEST(GraspStep, CouplingSpringCarriesWhatTheUserFeels) {
  GraspWorld w = pinchedBall(0.075, 0.9);
  GraspScratch scratch(w.model);
  for (int i = 0; i < 3000; ++i) step(w.model, w.state, scratch, squeezing(3e-3, 2e-3));
  for (int f = 0; f < 2; ++f) {
    const engine::PointState& proxy = w.state.world.points[f];
    // At rest k (x_proxy - x_device); the damper's share has decayed below 1e-9 N after 3 s.
    EXPECT_LT((scratch.fingers[f].f_user_W - 1000 * (proxy.p_W - proxy.p_target_W)).norm(), 1e-8);
    EXPECT_NEAR(scratch.fingers[f].f_user_W.z(), -0.5 * 0.075 * 9.81, 1e-8);
  }
}

// The smallest grip that holds is m g / (2 mu); fingers at the height of the ball's centre, the
// springs sagged to the weight beforehand.
double slipAfter(double share_of_limit, double seconds) {
  const double mu = 0.5, mass = 0.1, stiffness = 1000;
  const double grip = share_of_limit * mass * 9.81 / (2 * mu);
  GraspWorld w = pinchedBall(mass, mu, stiffness);
  for (int f = 0; f < 2; ++f) w.state.world.points[f].p_target_W = w.state.world.points[f].p_W;
  GraspScratch scratch(w.model);
  const double sag = std::min(0.5 * mass * 9.81, mu * grip) / stiffness;
  const auto inputs = squeezing(grip / stiffness, sag);
  for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) step(w.model, w.state, scratch, inputs);
  const Vec3 middle = 0.5 * (w.state.world.points[0].p_W + w.state.world.points[1].p_W);
  return middle.z() - w.state.world.bodies[0].X_WI.p.z();
}

TEST(GraspStep, HoldsJustAboveTheFrictionLimitWithoutCreep) {
  EXPECT_LT(std::abs(slipAfter(1.02, 10)), 1e-12);  // round-off of 10,000 ticks, a thousandth of the bound
}

TEST(GraspStep, SlidesJustBelowTheFrictionLimit) { EXPECT_GT(slipAfter(0.98, 0.5), 1e-3); }

TEST(GraspStep, ForcesStayInTheFrictionConeWhileShaken) {
  GraspWorld w = pinchedBall(0.05, 0.4);
  GraspScratch scratch(w.model);
  bool slid = false, stuck = false;
  for (int i = 0; i < 5000; ++i) {
    const double shake = 8e-3 * std::sin(0.05 * i) * i / 5000;
    step(w.model, w.state, scratch, squeezing(1.5e-3, shake));
    for (const FingerReport& finger : scratch.fingers) {
      EXPECT_LE(finger.tangential_force, 0.4 * finger.normal_force * (1 + 1e-12));
      slid = slid || finger.sliding;
      stuck = stuck || (finger.touching && !finger.sliding);
    }
  }
  EXPECT_TRUE(slid && stuck);
}

TEST(GraspStep, DynamicFrictionTakesOverWhenTheFingerSlides) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"table", contact::HalfSpace{}, false, 0, {0.8, 0.5, 0, 0}});
  GraspModel model = buildGrasp(builder, {tests::softFinger("probe")});
  GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 0.008)});
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(1);
  double largest = 0;
  for (int i = 0; i < 1000; ++i) {
    inputs[0].v_WF = Vec3(0.1, 0, 0);
    inputs[0].p_WF = Vec3(1e-4 * i, 0, 0.007);  // 1 N on the table, 100 mm/s along it
    step(model, state, scratch, inputs);
    if (i > 100) largest = std::max(largest, scratch.fingers[0].tangential_force / scratch.fingers[0].normal_force);
  }
  EXPECT_TRUE(scratch.fingers[0].sliding);
  EXPECT_NEAR(scratch.fingers[0].tangential_force / scratch.fingers[0].normal_force, 0.5, 1e-12);
  EXPECT_LE(largest, 0.5 + 1e-12);  // steady sliding: it never sticks again
}

// Momentum of the ball changes by gravity and by the negative of what the fingers felt, tick by tick.
TEST(GraspStep, BallGetsWhatTheFingersGive) {
  GraspWorld w = pinchedBall(0.075, 0.6);
  GraspScratch scratch(w.model);
  for (int i = 0; i < 500; ++i) {
    const Vec3 before = w.state.world.bodies[0].v_W;
    step(w.model, w.state, scratch, squeezing(2e-3, 1e-3 * std::sin(0.02 * i)));
    const Vec3 on_fingers = scratch.fingers[0].f_contact_W + scratch.fingers[1].f_contact_W;
    const Vec3 change = 0.075 * (w.state.world.bodies[0].v_W - before) / 1e-3;
    // forces of a few N, one rounding each
    EXPECT_LT((change - (Vec3(0, 0, -0.075 * 9.81) - on_fingers)).norm(), 1e-12);
  }
}

TEST(GraspStep, BallHeldBelowItsCentreTurnsOverOnlyWithoutTorsion) {
  const auto turned = [](double torsion_radius) {
    GraspWorld w = pinchedBall(0.075, 0.9, 1000, torsion_radius);
    for (int f = 0; f < 2; ++f) {
      w.state.world.points[f].p_W = w.state.world.points[f].p_target_W = Vec3(f == 0 ? -0.028 : 0.028, 0.004, 0.1);
    }
    auto inputs = squeezing(2e-3);
    for (auto& input : inputs) input.p_WF.y() = 0.004;  // the line between the fingers passes 4 mm beside the centre
    GraspScratch scratch(w.model);
    for (int i = 0; i < 1000; ++i) step(w.model, w.state, scratch, inputs);
    const Quat& q = w.state.world.bodies[0].X_WI.q;
    return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
  };
  EXPECT_GT(turned(0), 0.05);
  EXPECT_LT(turned(3.3e-3), 0.2 * turned(0));
}

TEST(GraspStep, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  GraspWorld w = pinchedBall(0.075, 0.6, 1000, 3.3e-3);
  GraspScratch scratch(w.model);
  const auto inputs = squeezing(2e-3);
  const auto before = tests::allocationCount();
  for (int i = 0; i < 1000; ++i) step(w.model, w.state, scratch, inputs);
  EXPECT_EQ(tests::allocationCount(), before);
}

TEST(GraspStep, RestoredSnapshotGivesTheSameBits) {
  GraspWorld w = pinchedBall(0.075, 0.6);
  GraspScratch scratch(w.model);
  for (int i = 0; i < 300; ++i) step(w.model, w.state, scratch, squeezing(2e-3));
  GraspState copy = w.state;
  GraspScratch fresh(w.model);
  for (int i = 0; i < 300; ++i) {
    step(w.model, w.state, scratch, squeezing(2e-3, 1e-6 * i));
    step(w.model, copy, fresh, squeezing(2e-3, 1e-6 * i));
  }
  EXPECT_EQ(engine::hashOf(copy.world), engine::hashOf(w.state.world));
}

TEST(GraspStep, FarFingerReportsALowerBoundOfItsGap) {
  GraspWorld w = pinchedBall(0.075, 0.6);
  GraspScratch scratch(w.model);
  auto inputs = squeezing(0);
  inputs[0].p_WF = Vec3(-0.3, 0, 0.1);
  w.state.world.points[0].p_W = w.state.world.points[0].p_target_W = inputs[0].p_WF;
  step(w.model, w.state, scratch, inputs);
  EXPECT_FALSE(scratch.fingers[0].touching);
  EXPECT_LE(scratch.fingers[0].gap, 0.3 - 0.028 + 1e-12);
  EXPECT_GT(scratch.fingers[0].gap, 0.03);
}

// Force shading turns the force to the interpolated normal, but leaves the
// contact on the pad where the flat facet has it.
TEST(GraspStep, ForceShadingShowsTheFacetsPlaceOnThePad) {
  const Vec3 over_facet = Vec3(0.1, -0.15, 1).normalized() * 0.027;
  for (const contact::SurfaceVariant variant : {contact::SurfaceVariant::force, contact::SurfaceVariant::facet}) {
    contact::SurfaceOptions options;
    options.variant = variant;
    const auto ball = contact::SmoothMesh::build(contact::icosphere(0.02, 1), options);
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"ball", contact::Mesh{ball}, false, 0, {0.5, 0.5, 0, 0}});
    GraspModel model = buildGrasp(builder, {tests::softFinger("probe")});
    GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {over_facet});
    GraspScratch scratch(model);
    std::vector<FingerInput> inputs(1);
    inputs[0].p_WF = over_facet;
    step(model, state, scratch, inputs);
    ASSERT_TRUE(scratch.fingers[0].touching);
    const Vec3 C = scratch.world.points[0].p_mid_W;
    contact::SurfaceTracker tracker;
    contact::PatchCache cache(64);
    const contact::SurfaceContact c = ball->querySphere(C, model.fingers[0].radius, 0, tracker, cache).main();
    EXPECT_LT((scratch.fingers[0].n_W - c.n_B).norm(), 1e-12);
    const Vec2 of_facet = placeOnPad(model.fingers[0], (c.p_BS - C).normalized());
    // they touch midway along the force, which leans by up to 15 degrees: 0.26 r / h
    const double half_gap = 0.5 * std::abs(c.phi);
    EXPECT_LT((placeOnPad(model.fingers[0], scratch.fingers[0].touch) - of_facet).norm(),
              variant == contact::SurfaceVariant::facet ? 1e-12 : 0.3 * half_gap);
    const double of_force = (placeOnPad(model.fingers[0], -c.n_B) - of_facet).norm();
    EXPECT_EQ(of_force > half_gap, variant == contact::SurfaceVariant::force) << of_force;
  }
}

TEST(PadPlace, IsArcLengthFromThePadsCentre) {
  FingerModel finger;
  finger.radius = 0.008;
  const double angle = 0.7;
  const Vec3 distal = Vec3(std::sin(angle), 0, -std::cos(angle));
  EXPECT_LT((placeOnPad(finger, distal) - Vec2(0.008 * angle, 0)).norm(), 1e-17);
  EXPECT_EQ(placeOnPad(finger, Vec3(0, 0, -1)), Vec2(0, 0));
  // Radial is pad normal x distal: with the pad down and the tip along x it is -y.
  const Vec3 radial = Vec3(0, -std::sin(angle), -std::cos(angle));
  EXPECT_LT((placeOnPad(finger, radial) - Vec2(0, 0.008 * angle)).norm(), 1e-17);
}

}  // namespace
}  // namespace pincer::grasp
