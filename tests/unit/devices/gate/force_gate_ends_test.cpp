// Ends of the gate's ranges: a value at a limit is allowed, one beyond it isn't (devices/gate/force_gate.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "pincer/devices/gate/force_gate.h"

namespace pincer::devices {
namespace {

// Limits and times that have no rounding: powers of two of a second, whole newtons.
GateLimits roundLimits() {
  GateLimits limits;
  limits.peak_force = 8;
  limits.continuous_force = 2;
  limits.slew = 1024;
  limits.ramp_time = 0;
  limits.watchdog_time = 1.0 / 256;
  return limits;
}

GateInput inputAt(double now) {
  GateInput in;
  in.dt = 1.0 / 1024;
  in.now = in.sample.time = now;
  in.sample.valid = true;
  in.f_D = Vec3(1, 0, 0);
  return in;
}

GateState armedState() {
  GateState state;
  arm(state);
  return state;
}

// The force after so many ticks of 1/1024 s.
Vec3 forceAfter(int ticks, const GateLimits& limits, const Vec3& wanted, GateState& state) {
  Vec3 f = Vec3::Zero();
  for (int i = 0; i < ticks; ++i) {
    GateInput in = inputAt(state.armed_for + 1.0 / 1024);
    in.f_D = wanted;
    f = gateForce(limits, in, state);
  }
  return f;
}

TEST(ForceGateEnds, AForceAtThePeakIsLeftAsItIs) {
  GateState state = armedState();
  EXPECT_EQ(forceAfter(20, roundLimits(), Vec3(0, -8, 0), state), Vec3(0, -8, 0));
}

TEST(ForceGateEnds, ASpeedAtTheLimitIsAllowed) {
  GateLimits limits = roundLimits();
  limits.top_speed = 2;
  GateState state = armedState();
  GateInput in = inputAt(1);
  in.v_DF = Vec3(0, 2, 0);
  gateForce(limits, in, state);
  EXPECT_EQ(state.trip, Trip::kNone);
}

TEST(ForceGateEnds, ACallAfterTheWatchdogTimeIsJustInTime) {
  GateState state = armedState();
  GateInput in = inputAt(1);
  in.dt = roundLimits().watchdog_time;
  gateForce(roundLimits(), in, state);
  EXPECT_EQ(state.trip, Trip::kNone);
}

TEST(ForceGateEnds, ASampleAsOldAsTheWatchdogTimeIsFresh) {
  for (const double age : {1.0 / 256, -1.0 / 256}) {
    GateState state = armedState();
    GateInput in = inputAt(1);
    in.sample.time = 1 - age;
    gateForce(roundLimits(), in, state);
    EXPECT_EQ(state.trip, Trip::kNone) << age;
  }
}

TEST(ForceGateEnds, ASampleMayBeUsedTwice) {
  GateState state = armedState();
  GateInput in = inputAt(1);
  gateForce(roundLimits(), in, state);
  in.now += in.dt;
  gateForce(roundLimits(), in, state);
  EXPECT_EQ(state.trip, Trip::kNone);
}

TEST(ForceGateEnds, AMotorAtRestGathersNoHeat) {
  GateState state = armedState();
  forceAfter(100, roundLimits(), Vec3::Zero(), state);
  EXPECT_EQ(state.heat, 0);
}

TEST(ForceGateEnds, APeakJustAboveTheContinuousForceIsForItsTimeOnly) {
  GateLimits limits = roundLimits();
  limits.peak_force = 2.125;
  limits.thermal_time = 1;
  GateState state = armedState();
  EXPECT_NEAR(forceAfter(1000, limits, Vec3(9, 0, 0), state).x(), 2.125, 1e-9);
  EXPECT_NEAR(forceAfter(1024, limits, Vec3(9, 0, 0), state).x(), 2, 1e-3) << "ten time constants later";
}

// The last force overloads a joint in the new posture: torque cuts it by more than the slew allows. Nothing more is
// taken in that tick, whatever is wanted.
TEST(ForceGateEnds, WhereTorqueHasUsedUpTheSlewNothingElseMoves) {
  GateLimits limits = roundLimits();
  limits.peak_torque = Vec3::Ones();
  GateState state = armedState();
  GateInput in = inputAt(1);
  in.sample.J = Mat3(0.25 * Mat3::Identity());
  in.f_D = Vec3(4, 0, 0);
  for (int i = 0; i < 10; ++i) gateForce(limits, in, state);
  ASSERT_EQ(state.f_D, Vec3(4, 0, 0));
  in.sample.J = Mat3(2 * Mat3::Identity());
  in.f_D = Vec3(-4, 0, 0);
  EXPECT_NEAR((gateForce(limits, in, state) - Vec3(0.5, 0, 0)).norm(), 0, 1e-12);
}

TEST(ForceGateEnds, ATripForgetsTheForceBeforeTheNextCall) {
  GateState state = armedState();
  ASSERT_EQ(forceAfter(20, roundLimits(), Vec3(3, 0, 0), state), Vec3(3, 0, 0));
  trip(state, Trip::kOperator);
  EXPECT_EQ(state.f_D, Vec3::Zero());
  EXPECT_FALSE(state.armed);
}

TEST(ForceGateEnds, AClosedGateForgetsTheForceThatItsStateRemembers) {
  GateState state;
  state.f_D = Vec3(5, 0, 0);
  EXPECT_EQ(gateForce(roundLimits(), inputAt(1), state), Vec3::Zero());
  EXPECT_EQ(state.f_D, Vec3::Zero());
}

TEST(ForceGateEnds, ZeroIsNoLimitButNoRampIsOne) {
  const std::array<std::pair<const char*, double GateLimits::*>, 6> fields{
      {{"peak_force", &GateLimits::peak_force},
       {"continuous_force", &GateLimits::continuous_force},
       {"thermal_time", &GateLimits::thermal_time},
       {"slew", &GateLimits::slew},
       {"top_speed", &GateLimits::top_speed},
       {"watchdog_time", &GateLimits::watchdog_time}}};
  for (const auto& [name, field] : fields) {
    GateLimits limits;
    limits.*field = 0;
    EXPECT_EQ(problemWith(limits).value_or("").find(name), 0u) << name;
    limits.*field = 1e-6;
    EXPECT_FALSE(problemWith(limits)) << name;
  }
  EXPECT_FALSE(problemWith({.ramp_time = 0}));
}

TEST(ForceGateEnds, EachJointNeedsATorque) {
  for (int joint = 0; joint < 3; ++joint) {
    GateLimits limits;
    limits.peak_torque = Vec3::Constant(1e-6);
    EXPECT_FALSE(problemWith(limits));
    (*limits.peak_torque)[joint] = 0;
    EXPECT_EQ(problemWith(limits).value_or("").find("peak_torque"), 0u) << joint;
  }
}

TEST(ForceGateEnds, AnArmOfHalfANewtonNarrowsTheLimitsToo) {
  ArmCapabilities arm;
  arm.peak_force = 0.5;
  arm.continuous_force = 0.25;
  EXPECT_EQ(within(GateLimits{}, arm).peak_force, 0.5);
  EXPECT_EQ(within(GateLimits{}, arm).continuous_force, 0.25);
}

TEST(ForceGateEnds, AnArmThatTellsNoContinuousForceKeepsTheLimit) {
  ArmCapabilities arm;
  arm.peak_force = 0.5;
  arm.continuous_force = 0;
  EXPECT_EQ(within(GateLimits{}, arm).continuous_force, GateLimits{}.continuous_force) << "0: not told";
}

TEST(ForceGateEnds, SaysThatForcesAreZeroAfterATripAndOnlyThen) {
  const auto saysZero = [](Trip trip) { return describe(trip).find("Forces are zero") != std::string::npos; };
  EXPECT_FALSE(saysZero(Trip::kNone));
  for (const Trip trip : {Trip::kNotFinite, Trip::kOverSpeed, Trip::kStaleSample, Trip::kInvalidSample, Trip::kGaveUp,
                          Trip::kMissedDeadline, Trip::kException, Trip::kOperator})
    EXPECT_TRUE(saysZero(trip)) << describe(trip);
}

TEST(ForceGateEnds, AnAgeOfZeroIsntShownWithATrip) {
  GateState state;
  trip(state, Trip::kStaleSample);
  EXPECT_EQ(describe(GateLimits{}, state), describe(Trip::kStaleSample)) << "nothing was measured";
}

}  // namespace
}  // namespace pincer::devices
