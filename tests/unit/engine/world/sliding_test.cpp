// Sliding and leaving: errors of second order in the tick.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

WorldOptions inTicksOf(double h) {
  WorldOptions options;
  options.h = h;
  return options;
}

// A frictionless ball runs down a fixed one and leaves it where its weight no longer bends its path enough:
//   cos = (v_0^2 / g L + 2 cos_0) / 3,  v^2 = g L cos,  L the distance of the centres; from there
//                                                       its horizontal velocity stays v cos.
double errorOfLeaving(double h) {
  constexpr double kL = 0.12, kStart = 0.2, kSpeed = 0.3, kG = 9.81;
  WorldBuilder builder(inTicksOf(h));
  builder.addBody({"fixed", contact::Sphere{0.1}, false, 0, {0, 0}});
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.05, {0, 0}});
  const WorldModel model = builder.build();
  const Vec3 out_W(std::sin(kStart), 0, std::cos(kStart)), along_W(std::cos(kStart), 0, -std::sin(kStart));
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt(kL * out_W, kSpeed * along_W)}, {});
  const ScratchHandle scratch = makeScratch(model);
  for (int n = 0; n < static_cast<int>(0.45 / h); ++n) step(model, state, *scratch);
  const double cos = (kSpeed * kSpeed / (kG * kL) + 2 * std::cos(kStart)) / 3;
  EXPECT_GT(state.bodies[1].X_WI.p.norm(), 2 * kL);
  return std::abs(state.bodies[1].v_W.x() - std::sqrt(kG * kL * cos) * cos);
}

// It was pushed once more after it had left: 2.5 mm/s at 1 ms, 7.8 mm/s at 4.
TEST(Sliding, ABallThatLeavesAnotherIsNotPushedOnceMore) {
  EXPECT_LT(errorOfLeaving(1e-3), 3e-6);  // 0.7e-6, whose sign depends on the phase of the tick
  EXPECT_LT(errorOfLeaving(4e-3), 2e-4);
}

struct Stop {
  double way = 0, turn = 0;  // [m, rad]
};

// A slab of 100 x 100 x 4 mm that slides at 0.5 m/s and spins at 20 rad/s, after it has stopped.
Stop stopOfSlab(double h) {
  WorldBuilder builder(inTicksOf(h));
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.3, 0.3}});
  builder.addBody({"slab", contact::Box{Vec3(0.05, 0.05, 0.002)}, true, 0.2, {0.3, 0.3}});
  const WorldModel model = builder.build();
  WorldState state =
      makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.002), Vec3(0.5, 0, 0), Vec3(0, 0, 20))}, {});
  const ScratchHandle scratch = makeScratch(model);
  for (int n = 0; n < static_cast<int>(0.4 / h); ++n) step(model, state, *scratch);
  const Quat& q = state.bodies[1].X_WI.q;
  EXPECT_EQ(state.bodies[1].v_W, Vec3(0, 0, 0));
  return {state.bodies[1].X_WI.p.x(), 2 * std::atan2(q.z(), q.w())};
}

// Friction pointed against the slip at the end of each tick: 76 um short at 1 ms, and half of that at 0.5.
TEST(Sliding, ASlabThatSlidesAndSpinsStopsWhereItDoesInFineTicks) {
  const Stop fine = stopOfSlab(3.125e-5), coarse = stopOfSlab(1e-3);
  EXPECT_NEAR(coarse.way, fine.way, 4e-6);    // 1.5e-6
  EXPECT_NEAR(coarse.turn, fine.turn, 5e-5);  // 1.7e-5, 1.6e-3 before
}

}  // namespace
}  // namespace pincer::engine
