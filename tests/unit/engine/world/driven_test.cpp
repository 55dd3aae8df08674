// Bodies that follow a given motion, and what rests on them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/step.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::kGravity;
using tests::startAt;

// A box of 40 x 40 x 20 mm on a driven plate whose upper side is at z = 0.
struct Carried {
  WorldModel model;
  WorldState state;
  WorldScratch scratch;

  explicit Carried(double mu, const BodyStart& plate = startAt(Vec3(0, 0, -0.01)), const Vec3& box = Vec3(0, 0, 0.01))
      : model(build(mu)), state(makeState(model, {plate, startAt(box)}, {})), scratch(model) {}
  StepReport tick(const MotionInput& plate) { return step(model, state, scratch, StepInputs{{}, {&plate, 1}}); }

 private:
  static WorldModel build(double mu) {
    WorldBuilder builder{WorldOptions{}};
    const Material material{mu, mu, 0, 0};
    builder.addBody({"plate", contact::Cylinder{0.2, 0.01}, false, 0, material, true});
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.1, material});
    return builder.build();
  }
};

MotionInput moving(const Vec3& p_W, const Vec3& v_W, const Vec3& turn_W = Vec3::Zero(),
                   const Vec3& w_W = Vec3::Zero()) {
  return {{quatFromRotationVector(turn_W), p_W}, {v_W, w_W}};
}

// A sphere that rolls on a plate with acceleration a has 2/7 of it: m x'' = f,
// (2/5) m r^2 w' = f r, r w = v_plate - x'.
TEST(DrivenBody, PlateThatAcceleratesRollsABallWithTwoSeventhsOfIt) {
  Carried world(0.5);
  const double a = 2;
  for (int i = 1; i <= 500; ++i) {
    const double t = 1e-3 * i;
    ASSERT_EQ(world.tick(moving(Vec3(0.5 * a * t * t, 0, -0.01), Vec3(a * t, 0, 0))).status, kStepOk);
  }
  EXPECT_NEAR(world.state.bodies[1].X_WI.p.x(), 2.0 / 7 * 0.5 * a * 0.25, 1e-8);
  EXPECT_NEAR(world.state.bodies[1].v_W.x(), 2.0 / 7 * a * 0.5, 1e-8);
  EXPECT_NEAR(world.state.bodies[1].X_WI.p.z(), 0.01, 1e-9);
}

TEST(DrivenBody, TurnsWithoutAngularMomentum) {
  Carried world(0.5);
  const Vec3 w_W(0, 0, 3);
  for (int i = 1; i <= 20; ++i) world.tick(moving(Vec3(0, 0, -0.01), Vec3::Zero(), 1e-3 * i * w_W, w_W));
  EXPECT_EQ(world.state.bodies[0].L_W, Vec3::Zero());
  EXPECT_EQ(bodyAngularVelocity(world.model, world.state, 0), w_W);
  const std::uint64_t hash = hashOf(world.state);
  world.state.driven_w_W[0].z() = 4;
  EXPECT_NE(hashOf(world.state), hash);
}

// Beyond mu g 7/2 the ball slips: x'' = mu g.
TEST(DrivenBody, PlateThatIsPulledAwayLeavesFrictionBehind) {
  Carried world(0.1);
  const double a = 20;
  for (int i = 1; i <= 100; ++i) {
    const double t = 1e-3 * i;
    world.tick(moving(Vec3(0.5 * a * t * t, 0, -0.01), Vec3(a * t, 0, 0)));
  }
  EXPECT_NEAR(world.state.bodies[1].v_W.x(), 0.1 * kGravity * 0.1, 1e-8);
}

TEST(DrivenBody, PlateThatRisesLiftsAndOneThatDropsIsLeftBehind) {
  Carried world(0.5);
  double worst = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double t = 1e-3 * i;
    const double z = 0.05 * (1 - std::cos(2 * M_PI * t)), v = 0.05 * 2 * M_PI * std::sin(2 * M_PI * t);
    world.tick(moving(Vec3(0, 0, z - 0.01), Vec3(0, 0, v)));
    worst = std::max(worst, std::abs(world.state.bodies[1].X_WI.p.z() - z - 0.01));
  }
  EXPECT_LT(worst, 1e-7);  // the largest acceleration is 2 m/s^2: it never lifts off, and follows to second order
  const double drop = world.state.bodies[1].X_WI.p.z();
  for (int i = 1; i <= 100; ++i)
    world.tick(moving(Vec3(0, 0, -0.01 - 20 * 0.5e-6 * i * i), Vec3(0, 0, -20 * 1e-3 * i)));
  EXPECT_NEAR(world.state.bodies[1].X_WI.p.z(), drop - 0.5 * kGravity * 0.01, 1e-6);
}

TEST(DrivenBody, MotionThatIsNoNumberIsReportedAndRests) {
  Carried world(0.5);
  MotionInput bad = moving(Vec3(0, 0, -0.01), Vec3::Zero());
  bad.motion.v_W.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(world.tick(bad).status & kInputNotFinite);
  EXPECT_EQ(world.state.bodies[0].X_WI.p, Vec3(0, 0, -0.01));
  EXPECT_EQ(step(world.model, world.state, world.scratch).status, kStepOk);  // no motion given: it rests
  EXPECT_NEAR(world.state.bodies[1].X_WI.p.z(), 0.01, 1e-12);
}

TEST(DrivenBody, CubicMeetsBothEnds) {
  const DrivenPlace start{{quatFromRotationVector(Vec3(0, 0, 0.1)), Vec3(1, 2, 3)}, {Vec3(0.1, 0, 0), Vec3(0, 0, 1)}};
  const DrivenPlace end{{quatFromRotationVector(Vec3(0, 0, 0.3)), Vec3(1.2, 2, 3)}, {Vec3(0.3, 0, 0), Vec3(0, 0, 3)}};
  const DrivenPlace middle = drivenPlace(start, end, 0.1, 0.5);
  EXPECT_NEAR(rotationVectorOf(middle.X_WB.q).z(), 0.2 + 0.1 * (1 - 3) / 8, 1e-15);
  EXPECT_NEAR(middle.X_WB.p.x(), 1.1 + 0.1 * (0.1 - 0.3) / 8, 1e-15);
  EXPECT_NEAR((drivenPlace(start, end, 0.1, 0).X_WB.p - start.X_WB.p).norm(), 0, 1e-15);
  EXPECT_NEAR((drivenPlace(start, end, 0.1, 1).X_WB.p - end.X_WB.p).norm(), 0, 1e-15);
}

}  // namespace
}  // namespace pincer::engine
