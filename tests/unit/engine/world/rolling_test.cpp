// Resistance to rolling against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

constexpr double kRollerRadius = 0.02, kBallMass = 0.1, kStandardGravity = 9.81;

// A ball on a slope: gravity leans by `angle` towards +x.
WorldModel ballOnSlope(double mu, double rolling_radius, double torsion_radius, double angle) {
  WorldOptions options;
  options.gravity_W = kStandardGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
  WorldBuilder builder(options);
  const Material material{mu, mu, 0, torsion_radius, rolling_radius};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
  builder.addBody({"ball", contact::Sphere{kRollerRadius}, true, kBallMass, material});
  return builder.build();
}

// v = (R + k) w solves the motion with one k for ever: m v' = -f, I w' = f R - e_r^2 f w / (k w), f = mu m g k /
// sqrt(k^2 + e_r^2), with I = 2/5 m R^2. (f and the moment share the cone and are opposite to creep k w and turning e_r
// w; v' = (R + k) w' gives R k^2 + (7/5 R^2 - e_r^2) k - R e_r^2 = 0.)
double creepOf(double e_r) {
  const double b = 1.4 * kRollerRadius * kRollerRadius - e_r * e_r, c = kRollerRadius * e_r * e_r;
  return 2 * c / (b + std::sqrt(b * b + 4 * kRollerRadius * c));
}

TEST(Rolling, SlowsABallDownEvenly) {
  for (const double e_r : {2e-4, 2e-3}) {
    for (const double heading : {0.0, 0.7}) {
      const double mu = 0.5, v0 = 0.1, creep = creepOf(e_r);
      const double deceleration = mu * kStandardGravity * creep / std::hypot(creep, e_r), stop = v0 / deceleration;
      const Vec3 ahead(std::cos(heading), std::sin(heading), 0);
      const WorldModel model = ballOnSlope(mu, e_r, 0, 0);
      const Vec3 spin = v0 / (kRollerRadius + creep) * Vec3::UnitZ().cross(ahead);
      WorldState state =
          makeState(model, {tests::startAt(Vec3::Zero()), tests::startAt({0, 0, kRollerRadius}, v0 * ahead, spin)}, {});
      WorldScratch scratch(model);
      while (state.time < 0.5 * stop) step(model, state, scratch);
      // Forces are constant, so that the scheme is exact but for the solver's 1e-10 per tick.
      EXPECT_NEAR(state.bodies[1].v_W.dot(ahead), v0 - deceleration * state.time, 1e-8 * v0) << e_r << " " << heading;
      EXPECT_NEAR(state.bodies[1].X_WI.p.dot(ahead), v0 * state.time - 0.5 * deceleration * state.time * state.time,
                  1e-8 * v0 * stop);
      while (state.time < 2 * stop) step(model, state, scratch);
      // The tick in which it stops, at v <= a h, is of first order: a h^2 at most.
      EXPECT_NEAR(state.bodies[1].X_WI.p.dot(ahead), 0.5 * v0 * stop, deceleration * 1e-6) << e_r << " " << heading;
      EXPECT_LT(state.bodies[1].v_W.norm(), 1e-9);
    }
  }
}

// At rest friction f = m g sin th and moment f R share the cone: tan th <= mu e_r / sqrt(R^2 + e_r^2).
TEST(Rolling, HoldsABallOnASlopeUpToItsLimit) {
  const double mu = 0.8, e_r = 2e-3, limit = mu * e_r / std::hypot(kRollerRadius, e_r);
  const auto travelled = [&](double share) {
    const WorldModel model = ballOnSlope(mu, e_r, 0, std::atan(share * limit));
    WorldState state = makeState(model, {tests::startAt(Vec3::Zero()), tests::startAt({0, 0, kRollerRadius})}, {});
    WorldScratch scratch(model);
    for (int i = 0; i < 5000; ++i) step(model, state, scratch);
    return state.bodies[1].X_WI.p.x();
  };
  EXPECT_NEAR(travelled(0.999), 0, 1e-12);  // anchored: five seconds of solver tolerance don't add up
  EXPECT_GT(travelled(1.001), 1e-4);        // 1/2 (5/7) g 0.001 tan th t^2 is 7 mm
}

// With a torsional radius as well all five share the cone: spin, roll and slip stop together, and no energy is gained.
// (What it moved in the tick of stopping counts as stick offset and is undone, at less than a thousandth of its speed.)
TEST(Rolling, TakesEnergyOnly) {
  const WorldModel model = ballOnSlope(0.3, 1e-3, 2e-3, 0);
  WorldState state = makeState(
      model, {tests::startAt(Vec3::Zero()), tests::startAt({0, 0, kRollerRadius}, {0.2, 0.1, 0}, {3, 8, 20})}, {});
  WorldScratch scratch(model);
  double energy = kineticEnergy(model, state);
  const double start = energy;
  for (int i = 0; i < 3000; ++i) {
    const StepReport report = step(model, state, scratch);
    EXPECT_EQ(report.status & ~static_cast<std::uint32_t>(kStepOk), 0u) << i;
    EXPECT_LE(kineticEnergy(model, state), std::max(energy, 1e-7 * start) + 1e-12 * start) << i;
    energy = kineticEnergy(model, state);
  }
  EXPECT_LT(energy, 1e-15 * start);
}

}  // namespace
}  // namespace pincer::engine
