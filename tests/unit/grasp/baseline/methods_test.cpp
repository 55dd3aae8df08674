// Published ways to render a finger: each does what its authors say, where that is known exactly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "pincer/grasp/baseline.h"
#include "pincer/grasp/baseline/nearest_outside.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/random_poses.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

struct OnPlate {
  GraspModel model;
  GraspState state;
  GraspScratch scratch;
  BaselineFingers fingers;
  std::vector<FingerInput> input = std::vector<FingerInput>(1);

  static GraspModel make(double mu_s, double mu_d) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, {mu_s, mu_d, 0, 0}});
    return buildGrasp(builder, {tests::softFinger("finger", 1000, 0)});
  }
  OnPlate(FingerMethod method, double mu_s, double mu_d)
      : model(make(mu_s, mu_d)),
        state(makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 8e-3)})),
        scratch(model),
        fingers({method}) {}
  const FingerReport& lead(const Vec3& p) {
    input[0].v_WF = (p - input[0].p_WF) / 1e-3;
    input[0].p_WF = p;
    return fingers.step(model, state, scratch, input).fingers[0];
  }
};

// Against brute force over a fine grid of the ball that holds all candidates.
TEST(NearestOutside, IsTheNearestPointOfTheWedge) {
  tests::RandomNumbers random(2);
  for (int i = 0; i < 200; ++i) {
    std::array<OuterSide, 4> planes;
    for (OuterSide& p : planes) p = {(tests::direction(random) + Vec3(0, 0, 1.5)).normalized(), random.uniform(-1, 1)};
    const Vec3 goal(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 0));
    const NearestOutside found = nearestOutside(planes, goal);
    Vec3 sum = goal;
    for (std::size_t k = 0; k < planes.size(); ++k) {
      EXPECT_GE(planes[k].n.dot(found.x), planes[k].b - 1e-9);
      EXPECT_GE(found.lambda[k], 0);
      EXPECT_LT(found.lambda[k] * std::abs(planes[k].n.dot(found.x) - planes[k].b), 1e-9);
      sum += found.lambda[k] * planes[k].n;
    }
    EXPECT_LT((sum - found.x).norm(), 1e-9);  // with the three before: the conditions of the minimum
  }
}

TEST(Baselines, AllPressWithTheSpringsForce) {
  for (const FingerMethod method :
       {FingerMethod::kGodObject, FingerMethod::kForceShading, FingerMethod::kPenalty, FingerMethod::kFrictionCone}) {
    OnPlate f(method, 0.5, 0.5);
    f.lead(Vec3(0, 0, 8e-3));
    for (int i = 1; i <= 100; ++i) f.lead(Vec3(0, 0, 8e-3 - 2e-5 * i));
    const FingerReport& felt = f.lead(Vec3(0, 0, 6e-3));
    EXPECT_NEAR(felt.f_user_W.z(), 2, 1e-9) << static_cast<int>(method);
    EXPECT_NEAR(felt.normal_force, 2, 1e-9);
    EXPECT_LT(f.lead(Vec3(0, 0, 9e-3)).normal_force, 1e-12);
  }
}

TEST(Baselines, GodObjectHasNoFriction) {
  OnPlate f(FingerMethod::kGodObject, 0.5, 0.5);
  f.lead(Vec3(0, 0, 8e-3));
  f.lead(Vec3(0, 0, 6e-3));
  for (int i = 1; i <= 50; ++i) f.lead(Vec3(1e-4 * i, 0, 6e-3));
  EXPECT_LT(f.scratch.fingers[0].tangential_force, 1e-9);
}

TEST(Baselines, ForceShadingSticksInTheConeAndSlidesOnIt) {
  OnPlate f(FingerMethod::kForceShading, 0.6, 0.4);
  f.lead(Vec3(0, 0, 8e-3));
  for (int i = 0; i < 3; ++i) f.lead(Vec3(0, 0, 6e-3));
  // 0.5 of the normal force: held by the spring, in full
  EXPECT_NEAR(f.lead(Vec3(1e-3, 0, 6e-3)).tangential_force, 1, 1e-9);
  for (int i = 1; i <= 100; ++i) f.lead(Vec3(1e-3 + 1e-4 * i, 0, 6e-3));
  // between the two cones
  EXPECT_NEAR(f.scratch.fingers[0].tangential_force / f.scratch.fingers[0].normal_force, 0.4, 0.21);
}

// Two cones: held until 0.6 of the normal force, then 0.4 of it for as long as it slips, in any
// direction, and held again once it is within 0.4.
TEST(Baselines, FrictionConeSlipsAtTheStaticConeAndSlidesOnTheDynamicOne) {
  OnPlate f(FingerMethod::kFrictionCone, 0.6, 0.4);
  f.lead(Vec3(0, 0, 8e-3));
  for (int i = 0; i < 3; ++i) f.lead(Vec3(0, 0, 6e-3));
  EXPECT_NEAR(f.lead(Vec3(1.19e-3, 0, 6e-3)).tangential_force, 1.19, 1e-9);  // 0.595 of 2 N
  EXPECT_FALSE(f.scratch.fingers[0].sliding);
  EXPECT_NEAR(f.lead(Vec3(1.21e-3, 0, 6e-3)).tangential_force, 0.8, 1e-9);
  EXPECT_TRUE(f.scratch.fingers[0].sliding);
  for (int i = 1; i <= 50; ++i) {
    const Vec3 way(1.21e-3 + 5e-5 * i, 1e-4 * i, 6e-3);
    EXPECT_NEAR(f.lead(way).tangential_force, 0.8, 1e-9);
  }
  const Vec3 back(1.21e-3 + 5e-5 * 50 - 2e-4, 1e-4 * 50, 6e-3);
  EXPECT_LT(f.lead(back).tangential_force, 0.8);
  EXPECT_FALSE(f.scratch.fingers[0].sliding);
}

TEST(Baselines, PenaltyCreepsUnderALoadThatFrictionShouldHold) {
  OnPlate f(FingerMethod::kPenalty, 0.5, 0.5);
  f.lead(Vec3(0, 0, 6e-3));
  EXPECT_LT(f.lead(Vec3(0, 0, 6e-3)).tangential_force, 1e-12);  // at rest nothing holds it
}

// As outer forces on bodies: a ball that two such fingers squeeze stays between
// them, and action is reaction over a tick.
TEST(Baselines, ActOnBodies) {
  for (const FingerMethod method :
       {FingerMethod::kGodObject, FingerMethod::kForceShading, FingerMethod::kPenalty, FingerMethod::kFrictionCone}) {
    tests::GraspWorld w = tests::pinchedBall(0.075, 0.6);
    w.model.world.options.gravity_W.setZero();
    BaselineFingers fingers({method, method});
    GraspScratch scratch(w.model);
    auto inputs = tests::squeezing(2e-3);
    for (int i = 0; i < 200; ++i) {
      const Vec3 before = w.state.world.bodies[0].v_W;
      fingers.step(w.model, w.state, scratch, inputs);
      const Vec3 change = 0.075 * (w.state.world.bodies[0].v_W - before) / 1e-3;
      EXPECT_LT((change + scratch.fingers[0].f_contact_W + scratch.fingers[1].f_contact_W).norm(), 1e-9);
    }
    EXPECT_LT((w.state.world.bodies[0].X_WI.p - Vec3(0, 0, 0.1)).norm(), 1e-3) << static_cast<int>(method);
  }
}

TEST(Baselines, AllocateNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  for (const FingerMethod method :
       {FingerMethod::kGodObject, FingerMethod::kForceShading, FingerMethod::kPenalty, FingerMethod::kFrictionCone}) {
    OnPlate f(method, 0.5, 0.5);
    f.lead(Vec3(0, 0, 6e-3));
    const auto before = tests::allocationCount();
    for (int i = 1; i <= 50; ++i) f.lead(Vec3(1e-4 * i, 0, 6e-3));
    EXPECT_EQ(tests::allocationCount(), before);
  }
}

}  // namespace
}  // namespace pincer::grasp
