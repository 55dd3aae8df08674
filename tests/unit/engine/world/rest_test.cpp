// Rest and sleep: the same bits with and without, awake at any change, and nothing taken from what moves.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

// A box on a slope that holds it, and another box on the box.
WorldModel boxesOnASlope(bool sleep) {
  WorldOptions options;
  options.sleep = sleep;
  options.gravity_W = 9.81 * Vec3(std::sin(0.2), 0, -std::cos(0.2));
  WorldBuilder builder(options);
  builder.addBody({"slope", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"lower", contact::Box{{0.03, 0.03, 0.0125}}, true, 0.2, {}});
  builder.addBody({"upper", contact::Box{{0.02, 0.015, 0.01}}, true, 0.1, {}});
  return builder.build();
}

struct RestWorld {
  explicit RestWorld(bool sleep) : model(boxesOnASlope(sleep)), scratch(model) {
    state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.0125}), startAt({0.002, 0.001, 0.035})}, {});
  }
  StepReport tick(int count) {
    StepReport report;
    for (int i = 0; i < count; ++i) report = step(model, state, scratch);
    return report;
  }
  WorldModel model;
  WorldScratch scratch;
  WorldState state;
};

TEST(Rest, HasTheSameBitsWithAndWithoutSleep) {
  RestWorld sleeps(true), stays(false);
  const auto push = [](RestWorld& w) { w.state.bodies[2].v_W += Vec3(0.02, 0.3, 0); };
  for (int part = 0; part < 20; ++part) {
    if (part == 10) push(sleeps), push(stays);
    const bool asleep = sleeps.tick(100).asleep;
    EXPECT_FALSE(stays.tick(100).asleep);
    EXPECT_EQ(hashOf(sleeps.state), hashOf(stays.state)) << part;
    EXPECT_TRUE(asleep || part == 10) << part;  // 100 ms after the start, 200 after the push nothing moves any more
  }
  EXPECT_GT(sleeps.state.bodies[2].X_WI.p.y(), 5e-3);  // it did move, by (0.3 m/s)^2 / (2 mu g), about 10 mm
}

// A sleeping tick reports as the last one did, and its contacts are still there to be read.
TEST(Rest, ReportsTheContactsOfTheLastTick) {
  RestWorld w(true);
  ASSERT_TRUE(w.tick(200).asleep);
  double weight = 0;
  for (const Contact& c : w.scratch.contacts) {
    if (c.a.index == 0 || c.b.index == 0) weight += c.r[2] / 1e-3;
  }
  EXPECT_NEAR(weight, 0.3 * 9.81 * std::cos(0.2), 1e-9);
  const std::int64_t before = w.state.tick;
  EXPECT_EQ(w.tick(1).contacts, static_cast<int>(w.scratch.contacts.size()));
  EXPECT_EQ(w.state.tick, before + 1);
  EXPECT_EQ(w.state.time, static_cast<double>(w.state.tick) * 1e-3);
}

TEST(Rest, WakesWhereTheStateIsSetFromOutside) {
  RestWorld w(true);
  ASSERT_TRUE(w.tick(200).asleep);
  w.state.bodies[1].X_WI.p.z() += 1e-15;
  EXPECT_FALSE(w.tick(1).asleep);
  RestWorld start(true);
  w.state = start.state;  // a snapshot from before, into the scratch of now
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(w.tick(1).asleep, start.tick(1).asleep);
    EXPECT_EQ(hashOf(w.state), hashOf(start.state)) << i;
  }
}

TEST(Rest, WakesWhenTheFloorMoves) {
  WorldBuilder builder{WorldOptions{}};
  BodySpec belt{"belt", contact::Box{{0.2, 0.2, 0.01}}, false, 0, {}};
  belt.driven = true;
  builder.addBody(belt);
  builder.addBody({"box", contact::Box{{0.02, 0.02, 0.02}}, true, 0.1, {}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model, {startAt({0, 0, -0.01}), startAt({0, 0, 0.02})}, {});
  WorldScratch scratch(model);
  MotionInput motion{{Quat::Identity(), {0, 0, -0.01}}, {}};
  StepReport report;
  for (int i = 0; i < 200; ++i) report = step(model, state, scratch, StepInputs{{}, {&motion, 1}});
  ASSERT_TRUE(report.asleep);
  for (int i = 1; i <= 100; ++i) {
    motion.X_WB.p.x() = 1e-5 * i;
    motion.motion.v_W.x() = 0.01;
    EXPECT_FALSE(step(model, state, scratch, StepInputs{{}, {&motion, 1}}).asleep);
  }
  EXPECT_NEAR(state.bodies[1].v_W.x(), 0.01, 1e-9);
}

// Slow isn't resting: without friction a nanometre per second goes on for ever.
TEST(Rest, LeavesSlowMotionAlone) {
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"ice", contact::HalfSpace{}, false, 0, {0, 0}});
  builder.addBody({"box", contact::Box{{0.02, 0.02, 0.02}}, true, 0.1, {0, 0}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt({0, 0, 0.02}, {1e-9, 0, 0})}, {});
  WorldScratch scratch(model);
  for (int i = 0; i < 2000; ++i) EXPECT_FALSE(step(model, state, scratch).asleep) << i;
  EXPECT_NEAR(state.bodies[1].v_W.x(), 1e-9, 1e-15);  // 2000 ticks of round-off of a millimetre-sized world
  EXPECT_NEAR(state.bodies[1].X_WI.p.x(), 2e-9, 1e-15);
}

// A drive that was told more than its range never slept: the state remembers what it was told cut off.
TEST(Rest, ADriveToldMoreThanItsRangeSleeps) {
  for (const double sign : {1.0, -1.0}) {
    WorldBuilder builder{WorldOptions{}};
    builder.addBody({"slide", contact::Box{Vec3::Constant(0.01)}, true, 0.1, {}});
    JointModel rail{JointKind::kSlider, 0, -1, {}, {}, 0};
    rail.traits.lower = -0.1;
    rail.traits.upper = 0.1;
    DriveModel servo;
    servo.terms = {{builder.addJoint(rail), 1}};
    servo.control = DriveModel::Control::kPosition;
    servo.stiffness = 1e4;
    servo.damping = 100;
    servo.lower_control = -0.05;
    servo.upper_control = 0.05;
    builder.addDrive(servo);
    const WorldModel model = builder.build();
    WorldState state = makeState(model, {startAt(Vec3::Zero())}, {});
    WorldScratch scratch(model);
    const auto told = [&](double control) {
      const DriveInput input{control, 0, false};
      StepInputs inputs;
      inputs.controls = {&input, 1};
      return step(model, state, scratch, inputs).asleep;
    };
    bool asleep = false;
    for (int i = 0; i < 2000; ++i) asleep = told(sign * 0.07);
    EXPECT_TRUE(asleep);
    EXPECT_NEAR(jointPosition(model, state, 0), sign * 0.05 - 0.1 * 9.81 / 1e4, 1e-9);
    EXPECT_TRUE(told(sign * 0.08));   // cut off where the last one was
    EXPECT_FALSE(told(sign * 0.03));  // within the range: it moves
    for (int i = 0; i < 2000; ++i) asleep = told(sign * 0.03);
    EXPECT_TRUE(asleep);
    EXPECT_NEAR(jointPosition(model, state, 0), sign * 0.03 - 0.1 * 9.81 / 1e4, 1e-9);
  }
}

}  // namespace
}  // namespace pincer::engine
