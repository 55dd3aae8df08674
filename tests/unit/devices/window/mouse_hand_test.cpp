#include "pincer/devices/window/mouse_hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pincer::devices {
namespace {

constexpr double kTick = 1e-3;

MouseHand pinchingHand(const MouseHandSettings& settings = {}) {
  MouseMount left, right;
  left.start_H = Vec3(-0.05, 0, 0.02);
  right.start_H = Vec3(0.05, 0, 0.02);
  return MouseHand({left, right}, settings);
}

// Fingers that meet a wall of stiffness 1000 N/m at |x| = 20 mm, as virtual couplings do.
void pressOnWalls(MouseHand& hand, double seconds) {
  for (int i = 0; i < std::lround(seconds / kTick); ++i) {
    hand.advance(kTick);
    for (int f = 0; f < 2; ++f) {
      const double side = f == 0 ? -1 : 1, inside = std::max(0.020 - side * hand.place_H(f).x(), 0.0);
      hand.commandForce_H(f, Vec3(side * 1000 * inside, 0, 0));
    }
  }
}

// The arm's spring and the wall's carry the same force: the grip, however long one squeezes.
TEST(MouseHand, NeverPressesHarderThanItsGrip) {
  MouseHandSettings settings;
  settings.grip = 1.5;
  MouseHand hand = pinchingHand(settings);
  hand.squeeze(true);
  pressOnWalls(hand, 4);
  // damped out to exp(-60) long ago; 1 tick's lag
  for (int f = 0; f < 2; ++f) EXPECT_NEAR(std::abs(hand.arm(f).force_D().x()), 1.5, 1e-3);
}

TEST(MouseHand, OpensAgainWhenTheButtonIsReleased) {
  MouseHand hand = pinchingHand();
  hand.squeeze(true);
  pressOnWalls(hand, 1);
  hand.squeeze(false);
  pressOnWalls(hand, 2);
  EXPECT_NEAR(hand.place_H(1).x() - hand.place_H(0).x(), 0.1, 1e-6);
}

TEST(MouseHand, FollowsTheMouseNoFasterThanItsTopSpeed) {
  MouseHandSettings settings;
  settings.top_speed = 0.4;
  MouseHand hand = pinchingHand(settings);
  hand.move(Vec3(0, 0, 0.1));
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    hand.advance(kTick);
    fastest = std::max(fastest, hand.velocity_H(0).norm());
  }
  EXPECT_NEAR(hand.place_H(0).z(), 0.12, 1e-6);
  // a damping ratio of 0.9 overshoots a ramp's speed by exp(-pi zeta / sqrt(1 - zeta^2)) = 0.15 %
  EXPECT_LT(fastest, 1.1 * 0.4);
}

// A force of 2 N moves the finger by f/k = 5 mm: that is how it shows.
TEST(MouseArm, YieldsToAForceAsASpringDoes) {
  MouseArm arm;
  for (int i = 0; i < 1000; ++i) {
    arm.commandForce(Vec3(2, 0, 0));
    arm.advance(kTick);
  }
  EXPECT_NEAR(arm.sample().p_DF.x(), 2.0 / 400, 1e-9);
  EXPECT_NEAR(arm.sample().v_DF->norm(), 0, 1e-9);
}

TEST(MouseArm, IgnoresAForceThatIsNone) {
  MouseArm arm;
  arm.commandForce(Vec3(NAN, 0, 0));
  arm.advance(kTick);
  EXPECT_TRUE(isFinite(arm.sample()));
  EXPECT_EQ(arm.force_D(), Vec3(Vec3::Zero()));
}

TEST(MouseHand, RefusesAThirdFinger) { EXPECT_THROW(MouseHand(std::vector<MouseMount>(3)), std::invalid_argument); }

}  // namespace
}  // namespace pincer::devices
