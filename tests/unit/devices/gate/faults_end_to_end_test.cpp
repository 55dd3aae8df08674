// Gate, simulated arm and display together in a servo's loop in virtual time: what
// reaches the motor when something breaks.
#include <gtest/gtest.h>

#include <algorithm>

#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/pad_policy.h"
#include "pincer/devices/cld/sim_cld.h"
#include "pincer/devices/gate/force_gate.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::devices {
namespace {

// A wall at y = 0 that the hand leans on, behind the gate.
struct Servo {
  SimArm plant;
  SimCld display;
  GateLimits limits;
  GateState gate;
  PadState pad;
  double now = 0;

  Servo() {
    limits.ramp_time = 0.1;
    plant.setHand({.p_D = Vec3(0, -6e-3, 0), .stiffness = 400});
    arm(gate);
  }
  void tick() {
    const ArmSample sample = plant.sample();
    GateInput in;
    in.sample = sample;
    in.now = now;
    in.f_D = Vec3(0, 1500 * std::max(0.0, -sample.p_DF.y()), 0);
    plant.commandForce(gateForce(limits, in, gate));
    PadInput touch;
    touch.contact_count = 1;
    touch.contacts[0] = {Vec2(2e-3, 1e-3), in.f_D.norm()};
    display.command(padCommand({}, touch, 1e-3, pad));
    plant.advance(1e-3);
    display.advance(1e-3);
    now += 1e-3;
  }
};

class Faults : public ::testing::TestWithParam<std::pair<SimFault, Trip>> {};

TEST_P(Faults, BringTheMotorToZeroWithinFiveMilliseconds) {
  Servo servo;
  for (int i = 0; i < 500; ++i) servo.tick();
  ASSERT_GT(servo.plant.motorForce_D().y(), 1);
  servo.plant.setFault(GetParam().first);
  for (int i = 0; i < 5; ++i) servo.tick();
  EXPECT_EQ(servo.plant.motorForce_D(), Vec3::Zero());
  EXPECT_EQ(servo.gate.trip, GetParam().second);
  servo.plant.setFault(SimFault::kNone);
  for (int i = 0; i < 500; ++i) servo.tick();
  EXPECT_EQ(servo.plant.motorForce_D(), Vec3::Zero()) << "forces came back without an operator";
}

INSTANTIATE_TEST_SUITE_P(EachFault, Faults,
                         ::testing::Values(std::pair(SimFault::kFrozenSamples, Trip::kStaleSample),
                                           std::pair(SimFault::kInvalidSamples, Trip::kInvalidSample),
                                           std::pair(SimFault::kNotFinitePosition, Trip::kNotFinite),
                                           std::pair(SimFault::kUnplugged, Trip::kInvalidSample)));

TEST(DevicesTick, AllocatesNothing) {
  if (!pincer::tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Servo servo;
  const auto before = pincer::tests::allocationCount();
  for (int i = 0; i < 1000; ++i) servo.tick();
  EXPECT_EQ(pincer::tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::devices
