// A held object sleeps, with what the fingers feel unchanged, and wakes when a finger or its force moves.
#include <gtest/gtest.h>

#include <algorithm>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

TEST(FingerSleep, HoldsAPinchAndWakesAtATouch) {
  tests::GraspWorld w = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3),
                    other = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3);
  other.model.world.options.sleep = false;
  GraspScratch scratch(w.model), other_scratch(other.model);
  std::vector<FingerInput> inputs = tests::squeezing(2e-3);
  const auto tick = [&] {
    const bool asleep = step(w.model, w.state, scratch, inputs).asleep;
    step(other.model, other.state, other_scratch, inputs);
    EXPECT_EQ(engine::hashOf(w.state.world), engine::hashOf(other.state.world)) << w.state.world.tick;
    for (std::size_t f = 0; f < 2; ++f) EXPECT_EQ(scratch.fingers[f].f_contact_W, other_scratch.fingers[f].f_contact_W);
    return asleep;
  };
  bool asleep = false;
  for (int i = 0; i < 1500; ++i) asleep = tick();
  ASSERT_TRUE(asleep);
  inputs[0].q_WF = Quat(Eigen::AngleAxisd(1e-3, Vec3::UnitZ()));  // the pad turns, and the ball with it
  EXPECT_FALSE(tick());
  for (int i = 0; i < 1500; ++i) asleep = tick();
  EXPECT_TRUE(asleep);
  inputs[1].f_W.z() = 1e-6;
  EXPECT_FALSE(tick());
  inputs[1].f_W.z() = 0;
  inputs[0].p_WF.x() += 1e-9;
  EXPECT_FALSE(tick());
}

// Three boxes on a floor, of which a finger pushes the first to the others, and goes back.
tests::GraspWorld pushedBoxes(bool sleep) {
  engine::WorldOptions options;
  options.sleep = sleep;
  engine::WorldBuilder builder(options);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  std::vector<engine::BodyStart> starts{tests::startAt(Vec3::Zero())};
  for (int k = 0; k < 3; ++k) {
    builder.addBody({"box", contact::Box{{0.01, 0.02, 0.01}}, true, 0.05, {}});
    starts.push_back(tests::startAt({0.04 * k, 0, 0.01}));
  }
  tests::GraspWorld w{buildGrasp(builder, {tests::softFinger("finger")}), {}};
  w.state = makeState(w.model, starts, {Vec3(-0.03, 0, 0.01)});
  return w;
}

TEST(FingerSleep, WhatItDoesntTouchSleepsWithTheSameBits) {
  tests::GraspWorld w = pushedBoxes(true), other = pushedBoxes(false);
  GraspScratch scratch(w.model), other_scratch(other.model);
  FingerInput input;
  std::array<int, 4> asleep{};
  for (int i = 0; i < 1200; ++i) {
    const double x = i < 600 ? 1e-4 * i : 1e-4 * (1200 - i);
    input.p_WF = Vec3(-0.03 + x, 0, 0.01);
    step(w.model, w.state, scratch, {&input, 1});
    step(other.model, other.state, other_scratch, {&input, 1});
    ASSERT_EQ(engine::hashOf(w.state.world), engine::hashOf(other.state.world)) << i;
    ASSERT_EQ(scratch.fingers[0].f_contact_W, other_scratch.fingers[0].f_contact_W) << i;
    ++asleep[static_cast<std::size_t>(scratch.world.sleep.bodies)];
  }
  EXPECT_GT(asleep[3], 300);  // before the touch and after it
  EXPECT_GT(asleep[2], 100);  // one is pushed
  EXPECT_GT(asleep[1], 100);  // against another
}

// Boxes on a plank, all one island of a world with a broad phase: the finger that wakes it touches in that tick.
TEST(FingerSleep, WhatWakesAllOfALargeWorldTouchesItAtOnce) {
  constexpr int kBoxes = 20;
  const auto loadedPlank = [](bool sleep) {
    engine::WorldOptions options;
    options.sleep = sleep;
    engine::WorldBuilder builder(options);
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
    builder.addBody({"plank", contact::Box{{0.5, 0.05, 0.01}}, true, 1, {}});
    std::vector<engine::BodyStart> starts{tests::startAt(Vec3::Zero()), tests::startAt({0, 0, 0.01})};
    for (int k = 0; k < kBoxes; ++k) {
      builder.addBody({"box", contact::Box{{0.01, 0.02, 0.01}}, true, 0.05, {}});
      starts.push_back(tests::startAt({-0.45 + 0.04 * k, 0, 0.03}));
    }
    tests::GraspWorld w{buildGrasp(builder, {tests::softFinger("finger")}), {}};
    w.state = makeState(w.model, starts, {Vec3(-0.5, 0, 0.03)});
    return w;
  };
  tests::GraspWorld w = loadedPlank(true), other = loadedPlank(false);
  GraspScratch scratch(w.model), other_scratch(other.model);
  FingerInput input;
  int asleep = 0, wakes = 0;
  for (int i = 0; i < 600; ++i) {
    input.p_WF = Vec3(-0.5 + 1e-4 * std::max(0, i - 100), 0, 0.03);
    const bool slept = scratch.world.sleep.bodies > kBoxes;
    step(w.model, w.state, scratch, {&input, 1});
    step(other.model, other.state, other_scratch, {&input, 1});
    ASSERT_EQ(engine::hashOf(w.state.world), engine::hashOf(other.state.world)) << i;
    asleep += slept;
    wakes += slept && scratch.world.sleep.bodies == 0;
  }
  EXPECT_GT(asleep, 50);
  EXPECT_GT(wakes, 0);
}

}  // namespace
}  // namespace pincer::grasp
