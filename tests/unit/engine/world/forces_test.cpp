// Forces on bodies and a changed gravity, as inputs of the step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

// One body that `options` and a caller's force move.
struct Pushed {
  WorldModel model;
  WorldState state;
  std::vector<BodyForce> forces;
  ScratchHandle scratch;

  Pushed(const WorldBuilder& builder, const std::vector<BodyStart>& starts)
      : model(builder.build()),
        state(makeState(model, starts, {})),
        forces(model.bodies.size()),
        scratch(makeScratch(model)) {}

  StepReport tick(std::optional<Vec3> gravity_W = {}) {
    return step(model, state, *scratch, {{}, {}, {forces, gravity_W}});
  }
  const BodyState& body(int i) const { return state.bodies[static_cast<std::size_t>(i)]; }
};

WorldOptions weightless() {
  WorldOptions options;
  options.gravity_W.setZero();
  return options;
}

const contact::Shape kBrick = contact::Box{Vec3(0.02, 0.03, 0.05)};

// F t^2 / 2 m and M t^2 / 2 I, exact in the tick but for round-off.
TEST(AppliedForces, MoveAFreeBodyAsNewtonAndEulerSay) {
  WorldBuilder builder(weightless());
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
  builder.addBody({"alone", kBrick, true, 0.2, {}});
  Pushed w(builder, {startAt(Vec3::Zero()), startAt(Vec3(1, 0, 0))});
  w.forces[0] = {Vec3(1, 2, -3), Vec3(0, 1e-4, 0)};
  w.forces[1] = {Vec3(0, 0, 1), Vec3(0, 0, 1e-3)};
  for (int n = 0; n < 500; ++n) ASSERT_EQ(w.tick().status, kStepOk);
  const double t = 0.5, I_ball = 0.4 * 0.1 * 0.02 * 0.02, I_brick = 0.2 / 3 * (0.02 * 0.02 + 0.03 * 0.03);
  EXPECT_LT((w.body(0).X_WI.p - t * t / 2 / 0.1 * Vec3(1, 2, -3)).norm(), 1e-12);
  EXPECT_LT((w.body(1).X_WI.p - Vec3(1, 0, t * t / 2 / 0.2)).norm(), 1e-12);
  EXPECT_NEAR(2 * std::atan2(w.body(0).X_WI.q.y(), w.body(0).X_WI.q.w()), t * t / 2 * 1e-4 / I_ball, 1e-11);
  EXPECT_NEAR(bodyAngularVelocity(w.model, w.state, 1).z(), t * 1e-3 / I_brick, 1e-11);
}

// Coulomb: stands below mu m g, and goes by F/m - mu g beyond it.
TEST(AppliedForces, PushABoxAlongTheFloor) {
  for (const double share : {0.99, 1.5}) {
    WorldBuilder builder{WorldOptions{}};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.4, 0.4}});
    builder.addBody({"box", contact::Box{Vec3(0.05, 0.05, 0.01)}, true, 0.5, {0.4, 0.4}});
    Pushed w(builder, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.01))});
    w.forces[1].f_W = Vec3(share * 0.4 * 0.5 * 9.81, 0, 0);
    for (int n = 0; n < 1000; ++n) ASSERT_EQ(w.tick().status, kStepOk) << n;
    EXPECT_NEAR(w.body(1).v_W.x(), share < 1 ? 0 : (share - 1) * 0.4 * 9.81, 1e-8);
    EXPECT_NEAR(w.body(1).X_WI.p.x(), share < 1 ? 0 : 0.5 * (share - 1) * 0.4 * 9.81, 1e-6);  // ticks count from 1 ms
  }
}

// A pivot and a slider take their share, a chain of two its momentum.
TEST(AppliedForces, MoveWhatJointsHold) {
  WorldBuilder builder(weightless());
  builder.addBody({"wheel", kBrick, true, 0.2, {}});
  builder.addBody({"sledge", contact::Sphere{0.02}, true, 0.1, {}});
  builder.addBody({"a", contact::Sphere{0.02}, true, 0.1, {}});
  builder.addBody({"b", contact::Sphere{0.02}, true, 0.3, {}});
  builder.addJoint({JointKind::kPivot, 0, -1, {}, {Quat::Identity(), Vec3::Zero()}});
  builder.addJoint({JointKind::kSlider, 1, -1, {}, {Quat::Identity(), Vec3(1, 0, 0)}});
  builder.addJoint({JointKind::kWeld, 2, 3, {Quat::Identity(), Vec3(0.1, 0, 0)}, {Quat::Identity(), Vec3(-0.1, 0, 0)}});
  Pushed w(builder, {startAt(Vec3::Zero()), startAt(Vec3(1, 0, 0)), startAt(Vec3(2, 0, 0)), startAt(Vec3(2.2, 0, 0))});
  w.forces[0] = {Vec3(5, 5, 5), Vec3(1, 1, 1e-3)};
  w.forces[1] = {Vec3(5, 5, 0.3), Vec3(1, 1, 1)};
  w.forces[2].f_W = Vec3(0.5, 0, 0);
  for (int n = 0; n < 500; ++n) ASSERT_EQ(w.tick().status, kStepOk);
  const double t = 0.5, I = 0.2 / 3 * (0.02 * 0.02 + 0.03 * 0.03);
  EXPECT_NEAR(bodyAngularVelocity(w.model, w.state, 0).z(), t * 1e-3 / I, 1e-10);
  EXPECT_NEAR(w.body(1).X_WI.p.z(), t * t / 2 * 0.3 / 0.1, 1e-12);
  EXPECT_NEAR(w.body(3).X_WI.p.x(), 2.2 + t * t / 2 * 0.5 / 0.4, 1e-10);
  EXPECT_NEAR(w.body(2).v_W.x(), t * 0.5 / 0.4, 1e-10);
}

// A pendulum that a steady torque of m g l sin(30 degrees) holds stands there, and one that starts
// level beside it swings about that place.
TEST(AppliedForces, ATorqueHoldsAPendulumUp) {
  const double m = 0.2, l = 0.1, angle = M_PI / 6;
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"bob", contact::Sphere{0.02}, true, m, {}});
  const Quat q_WJ(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));  // its z axis is -y
  builder.addJoint(
      {JointKind::kPivot, 0, -1, {q_WJ, l * Vec3(-std::sin(angle), 0, std::cos(angle))}, {q_WJ, Vec3::Zero()}});
  Pushed w(builder, {startAt(l * Vec3(std::sin(angle), 0, -std::cos(angle)))});
  w.forces[0].tau_W = Vec3(0, -m * 9.81 * l * std::sin(angle), 0);
  for (int n = 0; n < 2000; ++n) w.tick();
  EXPECT_LT((w.body(0).X_WI.p - l * Vec3(std::sin(angle), 0, -std::cos(angle))).norm(), 1e-12);
}

TEST(AppliedForces, AnotherGravityIsThatOfAWorldBuiltWithIt) {
  const auto drop = [](const Vec3& built_W, std::optional<Vec3> given_W) {
    WorldOptions options;
    options.gravity_W = built_W;
    WorldBuilder builder(options);
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0.6}});
    builder.addBody({"box", contact::Box{Vec3(0.03, 0.02, 0.01)}, true, 0.5, {0.5, 0.5, 0.6}});
    Pushed w(builder, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.05), Vec3(0.3, 0, 0), Vec3(1, 2, 3))});
    w.forces.clear();
    for (int n = 0; n < 600; ++n) w.tick(given_W);
    return hashOf(w.state);
  };
  const Vec3 moon_W(0.1, 0, -1.62);
  EXPECT_EQ(drop(moon_W, {}), drop(Vec3(0, 0, -9.81), moon_W));
}

// A body that sleeps under a force wakes when it changes, and sleeps again.
TEST(AppliedForces, WakeWhatSleeps) {
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  std::vector<BodyStart> starts{startAt(Vec3::Zero())};
  for (int i = 0; i < 2; ++i) {
    builder.addBody({"box", contact::Box{Vec3(0.01, 0.01, 0.01)}, true, 0.1, {}});
    starts.push_back(startAt(Vec3(0.1 * i, 0, 0.01)));
  }
  builder.addBody({"flying", contact::Sphere{0.01}, true, 0.1, {}});  // keeps the world awake
  starts.push_back(startAt(Vec3(0, 0, 50)));
  Pushed w(builder, starts), calm(builder, starts);
  w.forces[1].f_W = Vec3(0.1, 0, 0);
  for (int n = 0; n < 100; ++n) w.tick();
  const Vec3 p = w.body(1).X_WI.p;
  w.tick();
  EXPECT_EQ(w.body(1).X_WI.p, p);
  w.forces[1].f_W = Vec3(0, 0, 1.2);  // its weight is 0.981 N
  for (int n = 0; n < 100; ++n) w.tick();
  EXPECT_NEAR(w.body(1).X_WI.p.z() - 0.01, 0.5 * 0.01 * (1.2 - 0.981) / 0.1, 1e-8);
  w.forces.clear();
  w.tick();
  EXPECT_NEAR(w.body(1).v_W.z(), 0.1 * (1.2 - 0.981) / 0.1 - 9.81e-3, 1e-10);
}

TEST(AppliedForces, ThatArentFiniteAreFlaggedAndDoNothing) {
  for (const bool of_gravity : {false, true}) {
    WorldBuilder builder(weightless());
    builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
    Pushed w(builder, {startAt(Vec3::Zero())});
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    if (!of_gravity) w.forces[0].f_W.x() = kNan;
    EXPECT_EQ(w.tick(of_gravity ? std::optional<Vec3>(Vec3(0, 0, kNan)) : std::nullopt).status, kInputNotFinite);
    EXPECT_EQ(w.body(0).v_W, Vec3(0, 0, 0));
  }
}

}  // namespace
}  // namespace pincer::engine
