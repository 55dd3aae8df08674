// A scene in motion: quantities, expectations, and the promises of the tick (no allocation, same bits).
#include <gtest/gtest.h>

#include <numbers>

#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::tasks {
namespace {

constexpr const char* kFallingBall = R"({"version": 1, "duration": 0.2, "bodies": [
  {"name": "ball", "shape": {"type": "sphere", "radius": 0.02}, "mass": 0.1, "position": [0, 0, 1], "velocity": [0.5, 0, 0],
   "angular_velocity": [0, 0, 2]}],
  "fingers": [{"name": "tip", "position": [1, 0, 0]}],
  "expect": [
    {"quantity": "ball.v_x", "time": "always", "value": 0.5, "tolerance": 1e-12},
    {"quantity": "ball.p_z", "time": 0.1, "value": 0.95095, "tolerance": 1e-12},
    {"quantity": "ball.p_z", "time": "always", "relation": ">=", "value": 0.9}
  ]})";

Simulation falling() { return Simulation(parseScene(kFallingBall, "ball.json")); }

double measure(const Simulation& sim, std::span<const QuantityKind> kinds, std::string_view name) {
  for (const QuantityKind& kind : kinds) {
    if (kind.name == name) return kind.measure(sim.moment(), 0);
  }
  ADD_FAILURE() << "no quantity " << name;
  return 0;
}

TEST(Quantities, MeasureAFallingSpinningBall) {
  Simulation sim = falling();
  for (int i = 0; i < 100; ++i) sim.tick();
  const double t = 0.1, g = 9.81;
  EXPECT_NEAR(measure(sim, bodyQuantities(), "p_x"), 0.5 * t, 1e-15);
  EXPECT_NEAR(measure(sim, bodyQuantities(), "p_z"), 1 - 0.5 * g * t * t, 1e-13);  // 100 sums of numbers below 1
  EXPECT_NEAR(measure(sim, bodyQuantities(), "v_z"), -g * t, 1e-13);
  EXPECT_NEAR(measure(sim, bodyQuantities(), "speed"), std::hypot(0.5, g * t), 1e-13);
  EXPECT_NEAR(measure(sim, bodyQuantities(), "w_z"), 2, 1e-13);
  EXPECT_NEAR(measure(sim, bodyQuantities(), "rotation"), 2 * t, 1e-13);
  EXPECT_NEAR(measure(sim, bodyQuantities(), "L_z"), 2 * 0.4 * 0.1 * 4e-4, 1e-18);
  EXPECT_NEAR(measure(sim, worldQuantities(), "kinetic_energy"),
              0.05 * (0.25 + g * g * t * t) + 0.5 * 4 * 0.4 * 0.1 * 4e-4, 1e-13);
  EXPECT_NEAR(measure(sim, worldQuantities(), "energy"), 0.05 * 0.25 + 0.5 * 4 * 1.6e-5 + 0.1 * g, 1e-13);  // conserved
  EXPECT_EQ(measure(sim, fingerQuantities(), "p_x"), 1);
  EXPECT_EQ(measure(sim, fingerQuantities(), "touching"), 0);
}

TEST(AngleBetween, ResolvesTinyAndLargeAngles) {
  for (const double angle : {0.0, 1e-12, 0.3, std::numbers::pi - 1e-9}) {
    const Quat a = quatFromRotationVector({1, 2, -0.5});
    const Quat b = a * quatFromRotationVector(angle * Vec3(0.6, 0, 0.8));
    EXPECT_NEAR(angleBetween(a, b), angle, 2e-16 + 1e-15 * angle);
    EXPECT_NEAR(angleBetween(a, Quat(-b.coeffs())), angle, 2e-16 + 1e-15 * angle);  // q and -q are the same rotation
  }
}

TEST(ExpectationLog, TellsWhatHoldsAndWhatDoesNot) {
  Simulation sim = falling();
  ExpectationLog log(sim.scene().expectations);
  log.observe(0, 0, sim.moment());
  for (int i = 1; i <= 120; ++i) {
    sim.tick();
    log.observe(i, sim.time(), sim.moment());
  }
  EXPECT_TRUE(log.outcomes()[0].holds());
  EXPECT_TRUE(log.outcomes()[1].holds());
  EXPECT_TRUE(log.outcomes()[2].holds());
  EXPECT_FALSE(log.anyFailed());
  while (sim.ticks() < 200) {
    sim.tick();
    log.observe(sim.ticks(), sim.time(), sim.moment());
  }
  EXPECT_FALSE(log.outcomes()[2].holds());  // at 0.2 s it is 196 mm lower
  EXPECT_EQ(log.outcomes()[2].worst_time, 0.2);
  EXPECT_NEAR(log.outcomes()[2].worst_excess, 0.0962, 1e-12);
  EXPECT_TRUE(log.anyFailed());
}

TEST(ExpectationLog, SaysWhenItsTimeDidNotCome) {
  Simulation sim = falling();
  ExpectationLog log(sim.scene().expectations);
  log.observe(0, 0, sim.moment());
  EXPECT_FALSE(log.outcomes()[1].reached);
  EXPECT_FALSE(log.outcomes()[1].holds());
  EXPECT_FALSE(log.anyFailed());
}

TEST(Expectation, NaNNeverHolds) {
  for (const Relation relation : {Relation::kEqual, Relation::kAtMost, Relation::kAtLeast}) {
    Expectation expected;
    expected.relation = relation;
    expected.tolerance = 1e300;
    EXPECT_GT(expected.excess(std::nan("")), 0);
    EXPECT_LE(expected.excess(0), 0);
  }
}

TEST(Simulation, MovesFingersAlongTheirTrajectories) {
  const Scene scene = parseScene(R"({"version": 1, "duration": 1, "bodies": [], "fingers": [{"locked": ["x", "y", "z"],
    "trajectory": {"keyframes": [{"time": 0, "position": [0, 0, 0]}, {"time": 1, "position": [0, 0.1, 0]}]}}]})",
                                 "s.json");
  Simulation sim(scene);
  for (int i = 0; i < 500; ++i) sim.tick();
  // locked axes are where the device is at the tick's end
  EXPECT_NEAR(sim.state().world.points[0].p_W.y(), 0.05, 1e-15);
}

TEST(Simulation, TicksWithoutAllocatingAndTwiceToTheSameBits) {
  const Scene scene = readScene(PINCER_SOURCE_DIR "/tasks/scenes/pickup.json");
  Simulation first(scene), second(scene);
  const std::int64_t before = pincer::tests::allocationCount();
  for (int i = 0; i < 2000; ++i) first.tick();
  EXPECT_EQ(pincer::tests::allocationCount(), before);
  for (int i = 0; i < 2000; ++i) second.tick();
  EXPECT_EQ(engine::hashOf(first.state().world), engine::hashOf(second.state().world));
}

TEST(WholeTicks, AcceptsDecimalTimes) {
  EXPECT_EQ(wholeTicks(1.2, 1e-3), 1200);  // 1.2/1e-3 isn't 1200 in doubles
  EXPECT_EQ(wholeTicks(60, 1e-3), 60000);
  EXPECT_EQ(wholeTicks(0.0015, 1e-3), -1);
}

}  // namespace
}  // namespace pincer::tasks
