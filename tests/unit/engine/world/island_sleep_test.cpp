// Islands that rest beside something that moves aren't computed: the same bits as if they
// were, and awake as soon as anything differs.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

struct SleepWorld {
  SleepWorld(const WorldBuilder& builder, const std::vector<BodyStart>& starts)
      : model(builder.build()), state(makeState(model, starts, {})), scratch(model) {}
  StepReport tick(std::span<const MotionInput> motions = {}) {
    return step(model, state, scratch, StepInputs{{}, motions});
  }
  WorldModel model;
  WorldState state;
  WorldScratch scratch;
};

WorldOptions optionsOf(bool sleep, int threads = 1) {
  WorldOptions options;
  options.sleep = sleep;
  options.threads = threads;
  options.max_contacts = 512;
  return options;
}

contact::Shape randomShape(tests::RandomNumbers& random) {
  const double size = random.uniform(0.008, 0.015);
  const double kind = random.uniform(0, 4);
  if (kind < 1) return contact::Sphere{size};
  if (kind < 2) return contact::Capsule{size, size};
  if (kind < 3) return contact::Cylinder{size, size};
  return contact::Box{{size, 0.8 * size, 1.2 * size}};
}

// Stacks of one to three solids on a floor between which balls roll and bounce; more than 16
// bodies of odd seeds, so with a broad phase.
SleepWorld stacksAndBalls(int seed, bool sleep, int threads) {
  tests::RandomNumbers random(static_cast<std::uint64_t>(seed));
  WorldBuilder builder(optionsOf(sleep, threads));
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  std::vector<BodyStart> starts{startAt(Vec3::Zero())};
  const int stacks = seed % 2 ? 9 : 4;
  for (int k = 0; k < stacks; ++k) {
    double height = 0;
    for (int n = 0; n <= k % 3; ++n) {
      const Material material{0.5, 0.5, seed % 3 ? 0 : 0.4, 0, 1e-3};
      builder.addBody({"solid", randomShape(random), true, random.uniform(0.02, 0.2), material});
      starts.push_back(startAt({0.05 * (k % 3), 0.05 * (k / 3), height + 0.02}));
      height += 0.04;
    }
  }
  for (int k = 0; k < 2; ++k) {
    builder.addBody({"ball", contact::Sphere{0.01}, true, 0.1, {0.3, 0.3, 0.5}});
    starts.push_back(startAt({-0.1, 0.03 * k, 0.02}, {random.uniform(0.05, 0.3), random.uniform(-0.1, 0.1), 0}));
  }
  return {builder, starts};
}

TEST(IslandSleep, HasTheSameBitsAsWithoutSleep) {
  int slept = 0, woken = 0;
  for (int seed = 0; seed < 6; ++seed) {
    SleepWorld sleeps = stacksAndBalls(seed, true, 1 + seed % 2), stays = stacksAndBalls(seed, false, 1);
    for (int tick = 0; tick < 900; ++tick) {
      const int before = sleeps.scratch.sleep.bodies;
      const StepReport report = sleeps.tick(), other = stays.tick();
      ASSERT_EQ(hashOf(sleeps.state), hashOf(stays.state)) << "seed " << seed << ", tick " << tick;
      ASSERT_EQ(report.contacts, other.contacts) << "seed " << seed << ", tick " << tick;
      slept += sleeps.scratch.sleep.bodies;
      woken += sleeps.scratch.sleep.bodies < before;
      if (tick % 400 == 399) {
        const auto body = static_cast<std::size_t>(1 + (seed + tick) % 5);
        for (SleepWorld* w : {&sleeps, &stays}) w->state.bodies[body].v_W += Vec3(0.1, 0.2, 0.3);
      }
    }
  }
  EXPECT_GT(slept, 4000);  // body ticks
  EXPECT_GT(woken, 10);
}

// Memory that outlives a tick beside the state is no cause.
TEST(IslandSleep, ForgottenAtAnyTickChangesNoBit) {
  int slept = 0;
  for (int seed = 0; seed < 3; ++seed) {
    SleepWorld forgets = stacksAndBalls(seed, true, 1), remembers = stacksAndBalls(seed, true, 1);
    for (int tick = 0; tick < 700; ++tick) {
      slept += forgets.scratch.sleep.bodies;
      if (tick % 61 == 60) forgets.scratch.sleep = WorldSleep(forgets.model);
      forgets.tick();
      remembers.tick();
      ASSERT_EQ(hashOf(forgets.state), hashOf(remembers.state)) << "seed " << seed << ", tick " << tick;
    }
  }
  EXPECT_GT(slept, 1000);  // body ticks
}

TEST(IslandSleep, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  SleepWorld w = stacksAndBalls(1, true, 1);
  w.tick();  // the broad phase's first
  int slept = 0;
  const std::int64_t before = tests::allocationCount();
  for (int tick = 0; tick < 900; ++tick) {
    w.tick();
    slept += w.scratch.sleep.bodies;
  }
  EXPECT_EQ(tests::allocationCount() - before, 0);
  EXPECT_GT(slept, 500);
}

// Boxes that rest apart from each other, the last one on ice.
WorldBuilder boxesInARow(int count, const WorldOptions& options, std::vector<BodyStart>& starts) {
  WorldBuilder builder(options);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  starts = {startAt(Vec3::Zero())};
  for (int k = 0; k < count; ++k) {
    builder.addBody({"box", contact::Box{{0.01, 0.01, 0.01}}, true, 0.1, {}});
    starts.push_back(startAt({0.05 * k, 0, 0.01}));
  }
  builder.setPairMaterial(0, count, {0, 0});
  starts.back().v_W.y() = 0.1;
  return builder;
}

SleepWorld boxesBesideOneThatSlides(int count, bool sleep = true) {
  std::vector<BodyStart> starts;
  const WorldBuilder builder = boxesInARow(count, optionsOf(sleep), starts);
  SleepWorld w(builder, starts);
  for (int i = 0; i < 100; ++i) w.tick();
  return w;
}

TEST(IslandSleep, LooksOnlyAtWhatIsAwake) {
  for (const int count : {4, 30}) {
    SleepWorld w = boxesBesideOneThatSlides(count);
    const StepReport report = w.tick();
    EXPECT_EQ(w.scratch.sleep.bodies, count - 1);
    EXPECT_EQ(w.scratch.contacts.size(), 4u);
    EXPECT_EQ(report.contacts, 4 * count);
    double weight = 0;
    forEachContact(w.scratch, [&](const Contact& c) { weight += std::abs(c.impulse_W.z()) / 1e-3; });
    EXPECT_NEAR(weight, 0.1 * count * 9.81, 1e-9);
    EXPECT_NEAR(w.state.bodies.back().v_W.y(), 0.1, 1e-12);
  }
}

TEST(IslandSleep, WakesWhereItsStateOrItsFloorsIsSetFromOutside) {
  for (int what = 0; what < 5; ++what) {
    SleepWorld w = boxesBesideOneThatSlides(3), stays = boxesBesideOneThatSlides(3, false);
    ASSERT_EQ(w.scratch.sleep.bodies, 2);
    for (WorldState* state : {&w.state, &stays.state}) {
      if (what == 0) state->bodies[1].X_WI.p.z() += 1e-15;
      if (what == 1) state->bodies[0].X_WI.p.z() -= 1e-4;
      if (what == 2) state->contacts[0].r[2] *= 1 + 1e-3;
      if (what == 3) state->h_last *= 0.5;
      if (what == 4) state->bodies[2].v_W.x() = -0.3;  // towards the first
    }
    for (int i = 0; i < 300; ++i) {
      w.tick();
      stays.tick();
      ASSERT_EQ(hashOf(w.state), hashOf(stays.state)) << what << ", tick " << i;
    }
    EXPECT_NEAR(w.state.bodies[1].X_WI.p.z(), what == 1 ? 0.0099 : 0.01, 1e-9) << what;
    EXPECT_GT(w.scratch.sleep.bodies, 0) << what;
  }
}

TEST(IslandSleep, TakesASnapshotFromBefore) {
  std::vector<BodyStart> starts;
  const WorldBuilder builder = boxesInARow(3, optionsOf(true), starts);
  SleepWorld w(builder, starts), fresh(builder, starts);
  for (int i = 0; i < 100; ++i) w.tick();
  ASSERT_EQ(w.scratch.sleep.bodies, 2);
  w.state = fresh.state;
  for (int i = 0; i < 100; ++i) {
    w.tick();
    fresh.tick();
    ASSERT_EQ(hashOf(w.state), hashOf(fresh.state)) << i;
  }
}

TEST(IslandSleep, WakesWhenTheBeltUnderItStarts) {
  WorldBuilder builder(optionsOf(true));
  BodySpec belt{"belt", contact::Box{{0.2, 0.2, 0.01}}, false, 0, {}};
  belt.driven = true;
  builder.addBody(belt);
  builder.addBody({"box", contact::Box{{0.02, 0.02, 0.02}}, true, 0.1, {}});
  builder.addBody({"free", contact::Sphere{0.01}, true, 0.1, {}});
  // what falls beside it keeps the world awake
  SleepWorld w(builder, {startAt({0, 0, -0.01}), startAt({0, 0, 0.02}), startAt({1, 0, 0})});
  MotionInput motion{{Quat::Identity(), {0, 0, -0.01}}, {}};
  for (int i = 0; i < 200; ++i) w.tick({&motion, 1});
  ASSERT_EQ(w.scratch.sleep.bodies, 1);
  for (int i = 1; i <= 100; ++i) {
    motion.X_WB.p.x() = 1e-5 * i;
    motion.motion.v_W.x() = 0.01;
    w.tick({&motion, 1});
    EXPECT_EQ(w.scratch.sleep.bodies, 0);
  }
  EXPECT_NEAR(w.state.bodies[1].v_W.x(), 0.01, 1e-9);
}

}  // namespace
}  // namespace pincer::engine
