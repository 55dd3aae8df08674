// Contacts of what stands still are kept, and those of a scratch that remembers nothing have the same bits.
#include "pincer/engine/world/unchanged_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/engine/step.h"

namespace pincer::engine {
namespace {

struct Scene {
  WorldModel model;
  WorldState state;
};

// Rows of bricks, each beside its neighbour, some `jitter` [m] off. A ball rolls towards them at `speed` [m/s] and hits
// them in the end.
Scene wallAndBall(bool sleep, double jitter, double speed = 0.4) {
  constexpr int kColumns = 5, kRows = 3;
  WorldOptions options;
  options.sleep = sleep;
  WorldBuilder builder{options};
  std::vector<BodyStart> starts(1);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  for (int n = 0; n < kColumns * kRows; ++n) {
    builder.addBody({"brick", contact::Box{{0.02, 0.01, 0.01}}, true, 0.05, {}});
    const int row = n / kColumns, column = n % kColumns;
    const Vec3 off = jitter * Vec3(std::sin(3 * n), std::sin(5 * n), std::sin(7 * n));
    starts.push_back({{Quat::Identity(), Vec3(0.041 * column + 0.01 * (row % 2), 0, 0.02 * row + 0.01) + off}});
  }
  builder.addBody({"ball", contact::Sphere{0.01}, true, 0.02, {}});
  starts.push_back({{Quat::Identity(), Vec3(0.1, -0.12, 0.01)}, Vec3(0, speed, 0), Vec3::Zero()});
  Scene scene{builder.build(), {}};
  scene.state = makeState(scene.model, starts, {});
  return scene;
}

std::ptrdiff_t keptOf(const WorldScratch& scratch) {
  return std::count_if(scratch.contacts.begin(), scratch.contacts.end(),
                       [](const Contact& c) { return c.same_as >= 0; });
}

// Steps the scene with a scratch of its own and, from tick to tick, with new ones. Returns in how many ticks
// contacts were copied.
int compareWithForgetful(Scene scene, int ticks) {
  WorldState forgets = scene.state;
  const ScratchHandle scratch = makeScratch(scene.model);
  int kept = 0;
  for (int n = 0; n < ticks; ++n) {
    step(scene.model, scene.state, *scratch);
    step(scene.model, forgets, *makeScratch(scene.model));
    kept += keptOf(*scratch) > 0;
    EXPECT_EQ(hashOf(scene.state), hashOf(forgets)) << "tick " << n;
    if (hashOf(scene.state) != hashOf(forgets)) return kept;
  }
  return kept;
}

TEST(UnchangedPairs, HaveTheBitsOfThoseThatAreFound) {
  for (const bool sleep : {false, true}) {
    for (const double jitter : {0.0, 1e-5}) {
      const int kept = compareWithForgetful(wallAndBall(sleep, jitter), 350);
      EXPECT_GE(kept, sleep ? 0 : 50) << jitter;  // until the ball comes, or all sleeps
    }
  }
}

// The contacts of what flies off and comes back remembered how their bodies had moved when something last pushed them.
TEST(Scratch, OfBricksThatHopKeepsNothingThatTheNextTickReads) { compareWithForgetful(wallAndBall(false, 5e-5), 100); }

// A state set from outside in between: a snapshot, or what a contact remembers.
TEST(UnchangedPairs, AreFoundAgainWhereTheStateWasChanged) {
  const Scene scene = wallAndBall(false, 0);
  WorldState state = scene.state;
  const ScratchHandle scratch = makeScratch(scene.model);
  for (int n = 0; n < 150; ++n) step(scene.model, state, *scratch);
  ASSERT_GT(keptOf(*scratch), 0);
  const auto expect_same = [&](WorldState changed) {
    WorldState other = changed, go_on = state;
    step(scene.model, go_on, *scratch);  // keeps what `changed` mustn't be given
    step(scene.model, changed, *scratch);
    step(scene.model, other, *makeScratch(scene.model));
    EXPECT_EQ(hashOf(changed), hashOf(other));
  };
  expect_same(scene.state);
  WorldState changed = state;
  changed.contacts[5].r[kNormalRow] *= 1.5;
  expect_same(changed);
  changed = state;
  changed.contacts[7].t1_W = -changed.contacts[7].t1_W;
  expect_same(changed);
  changed = state;
  changed.bodies[3].v_W.x() = 1e-3;
  expect_same(changed);
}

// Not copied at all, as long as nothing moves; then a brick in the middle of them is off by a bit.
TEST(UnchangedPairs, StayInPlaceWhileNothingMoves) {
  Scene scene = wallAndBall(false, 0, 0);
  const ScratchHandle scratch = makeScratch(scene.model);
  for (int n = 0; n < 150; ++n) step(scene.model, scene.state, *scratch);
  const Contact* const place = scratch->contacts.data();
  const std::size_t count = scratch->contacts.size();
  for (int n = 0; n < 20; ++n) {
    if (n == 10) scene.state.bodies[8].X_WI.p.y() = std::nextafter(scene.state.bodies[8].X_WI.p.y(), 1.0);
    WorldState forgets = scene.state;
    step(scene.model, scene.state, *scratch);
    step(scene.model, forgets, *makeScratch(scene.model));
    EXPECT_EQ(hashOf(scene.state), hashOf(forgets)) << "tick " << n;
    EXPECT_EQ(scratch->contacts.size(), count);
    if (n <= 10) {
      EXPECT_EQ(scratch->contacts.data() == place, n < 10) << "tick " << n;
    }
  }
}

// All but the contact of the ball, which rolls; then those of a brick that was moved by a bit.
TEST(UnchangedPairs, OfWhatMovesAreFound) {
  Scene scene = wallAndBall(false, 0);
  const ScratchHandle scratch = makeScratch(scene.model);
  for (int n = 0; n < 150; ++n) step(scene.model, scene.state, *scratch);
  const auto all = static_cast<std::ptrdiff_t>(scratch->contacts.size());
  EXPECT_EQ(keptOf(*scratch), all - 1);  // but for the ball's
  scene.state.bodies[1].X_WI.p.y() = std::nextafter(scene.state.bodies[1].X_WI.p.y(), 1.0);
  step(scene.model, scene.state, *scratch);
  EXPECT_LT(keptOf(*scratch), all - 4);
  EXPECT_GT(keptOf(*scratch), all / 2);
}

}  // namespace
}  // namespace pincer::engine
