// Islands: what lies apart is solved apart, with the same bits alone, together, and on several threads.
#include <gtest/gtest.h>

#include <vector>

#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::engine {
namespace {

constexpr Material kWood{0.4, 0.35, 0, 0};

struct World {
  WorldModel model;
  WorldState state;
  int uncut = 0;  // ticks from the start that no landing cut
};

// `piles` pairs of balls, one leaning on the other, on a floor; 0.2 m apart. `first` leaves out those before it.
World piles(int first, int last, int threads) {
  WorldOptions options;
  options.threads = threads;
  WorldBuilder builder{options};
  std::vector<BodyStart> starts(1);
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, kWood});
  for (int k = first; k < last; ++k) {
    const double x = 0.2 * k, lean = 0.001 * k;
    builder.addBody({"lower", contact::Sphere{0.02}, true, 0.1, kWood});
    builder.addBody({"upper", contact::Sphere{0.015}, true, 0.05, kWood});
    starts.push_back({{Quat::Identity(), Vec3(x, 0, 0.02)}, Vec3::Zero(), Vec3::Zero()});
    starts.push_back({{Quat::Identity(), Vec3(x + 0.02 + lean, 0, 0.0436)}, Vec3::Zero(), Vec3(0, 3, 0)});
  }
  World w{builder.build(), {}, 0};
  w.state = makeState(w.model, starts, {});
  return w;
}

WorldState after(World& w, int ticks) {
  WorldScratch scratch(w.model);
  w.uncut = 0;
  for (int k = 0; k < ticks; ++k) {
    const bool whole = step(w.model, w.state, scratch).parts == 1;
    if (whole && w.uncut == k) ++w.uncut;
  }
  return w.state;
}

// Until the first upper ball lands: a landing cuts the tick for all.
TEST(Islands, AreSolvedTheSameAloneAndTogether) {
  World all = piles(0, 4, 1);
  after(all, 300);
  const int ticks = all.uncut;
  ASSERT_GT(ticks, 50);
  all = piles(0, 4, 1);
  const WorldState together = after(all, ticks);
  for (int k = 0; k < 4; ++k) {
    World one = piles(k, k + 1, 1);
    const WorldState alone = after(one, ticks);
    for (std::size_t body = 1; body <= 2; ++body) {
      const BodyState &x = alone.bodies[body], &y = together.bodies[2 * static_cast<std::size_t>(k) + body];
      EXPECT_EQ(x.X_WI.p, y.X_WI.p) << k;
      EXPECT_EQ(x.X_WI.q.coeffs(), y.X_WI.q.coeffs()) << k;
      EXPECT_EQ(x.v_W, y.v_W) << k;
    }
  }
}

TEST(Islands, AreSolvedTheSameOnSeveralThreads) {
  World one = piles(0, 6, 1), two = piles(0, 6, 2), four = piles(0, 6, 4);
  const std::uint64_t expected = hashOf(after(one, 300));
  EXPECT_EQ(hashOf(after(two, 300)), expected);
  EXPECT_EQ(hashOf(after(four, 300)), expected);
}

TEST(Islands, AreCountedByWhatTouches) {
  World w = piles(0, 3, 1);
  WorldScratch scratch(w.model);
  step(w.model, w.state, scratch);
  EXPECT_EQ(scratch.islands.islands.size(), 3u);
  for (const Island& island : scratch.islands.islands) {
    EXPECT_LE(island.movers, 2);
    EXPECT_TRUE(island.result.converged);
  }
}

TEST(Islands, AllocateNothingInTheTick) {
  if (!pincer::tests::allocationsAreCounted()) GTEST_SKIP() << "the sanitizer owns the allocator";
  World w = piles(0, 6, 2);
  WorldScratch scratch(w.model);
  const std::int64_t before = pincer::tests::allocationCount();
  for (int k = 0; k < 200; ++k) step(w.model, w.state, scratch);
  EXPECT_EQ(pincer::tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::engine
