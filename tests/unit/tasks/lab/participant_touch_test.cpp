#include <gtest/gtest.h>

#include <cmath>

#include "pincer/grasp/step.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/lab/participants/touch.h"

namespace pincer::tasks {
namespace {

SensingLimits exactTouch() {
  SensingLimits limits;
  limits.tactor_sd = limits.orientation_sd = limits.placement_sd = limits.placement_between_sd = limits.direction_sd =
      0;
  limits.tactor_bias = 1;
  limits.force_lag = 0;
  return limits;
}

struct TouchedSphere : ::testing::Test {
  SpherePickupOptions options;
  HandScene scene = makePickupScene(options, makePickupObject(options), {});
  Random random{5};

  Touch touchWith(const SensingLimits& limits) {
    Random draw(1);
    Touch touch;
    touch.begin(limits, scene.cues, drawBodySense(limits, draw));
    return touch;
  }
  // Both fingertips touch the sphere with their centres `offset_W` away from the pinch
  // line's middle, tactors where the contacts are.
  Percept percept(double time, const Vec3& offset_W, bool tactors = true) const {
    Percept percept;
    percept.time = time;
    for (std::size_t i = 0; i < 2; ++i) {
      const double reach = options.radius + options.hand.finger_radius;
      const double side = i == 0 ? -1 : 1;
      const Vec3 tip_W = offset_W + Vec3(side * std::sqrt(reach * reach - offset_W.squaredNorm()), 0, 0);
      const Quat q_FW = (scene.cues.fingers[i].q_WD * scene.q_DF[i]).conjugate();
      auto& finger = percept.fingers[i];
      finger.arm.time = time;
      finger.arm.valid = true;
      finger.arm.q_DF = scene.q_DF[i];
      finger.tactile = {time, true, Vec2(0, 0)};
      if (tactors) finger.tactile.place_L = grasp::placeOnPad(scene.model.grasp.fingers[i], q_FW * -tip_W.normalized());
    }
    return percept;
  }
};

// With perfect senses the reading is the geometry: a spherical tip on a sphere touches on the line of centres.
TEST_F(TouchedSphere, TellsHowFarTheCentreIsAcrossThePads) {
  for (const Vec3& offset_W : {Vec3(0, 0.004, 0), Vec3(0, 0, -0.007), Vec3(0, -0.003, 0.009)}) {
    Touch touch = touchWith(exactTouch());
    touch.feel(percept(0, offset_W, false));
    touch.feel(percept(1e-3, offset_W));
    const auto read_W = touch.readPlace(random);
    ASSERT_TRUE(read_W);
    EXPECT_LT((*read_W + offset_W).norm(), 1e-12);  // sine of an arctangent: some ulp of 28 mm
  }
}

TEST_F(TouchedSphere, IsFeltTowardsTheCentreOfThePad) {
  SensingLimits limits = exactTouch();
  limits.tactor_bias = 0.9;
  Touch touch = touchWith(limits);
  const double offset = 0.005, reach = options.radius + options.hand.finger_radius;
  touch.feel(percept(0, Vec3(0, offset, 0), false));
  touch.feel(percept(1e-3, Vec3(0, offset, 0)));
  EXPECT_NEAR(touch.readPlace(random)->y(), -reach * std::sin(0.9 * std::asin(offset / reach)), 1e-12);
}

TEST_F(TouchedSphere, TellsNothingWhereTheTactorsStandStill) {
  Touch touch = touchWith({});
  for (int i = 0; i < 100; ++i) touch.feel(percept(1e-3 * i, Vec3(0, 0.005, 0), false));
  EXPECT_FALSE(touch.readPlace(random));
}

// SD of one reading, mean of two fingers: (r + R)/r x 1.63 mm / sqrt 2 = 4.0 mm per
// axis. Five standard errors, SD/sqrt(2 n).
TEST_F(TouchedSphere, IsReadWithTheNoiseOfPublishedLocalisation) {
  SensingLimits limits = exactTouch();
  limits.tactor_sd = 1.63e-3;
  Touch touch = touchWith(limits);
  touch.feel(percept(0, Vec3(0, 0.003, 0), false));
  touch.feel(percept(1e-3, Vec3(0, 0.001, 0)));
  const int n = 4000;
  double squares = 0;
  for (int i = 0; i < n; ++i) squares += std::pow(touch.readPlace(random)->y() + 0.001, 2);
  const double expected = 28.0 / 8 * 1.63e-3 / std::sqrt(2.0);
  // sin(a) for a: at 1.63/8 rad the sine is 0.7 % short of the angle, over the tails about 2 %.
  EXPECT_NEAR(std::sqrt(squares / n), expected, (5 / std::sqrt(2.0 * n) + 0.03) * expected);
}

TEST_F(TouchedSphere, FeelsOnlyWhatPressesAgainstThePadAndExceedsTheFloor) {
  Touch touch = touchWith(exactTouch());
  Percept felt = percept(0, Vec3::Zero());
  // D's z points at the object
  for (std::size_t i = 0; i < 2; ++i) felt.fingers[i].f_D = Vec3(0, 0, i == 0 ? -0.5 : -0.05);
  touch.feel(felt);
  felt.time = 1e-3;
  touch.feel(felt);
  EXPECT_TRUE(touch.feels(0));
  EXPECT_NEAR(touch.force(0), 0.5, 1e-12);
  EXPECT_FALSE(touch.feels(1));  // 0.05 N is under the floor of 0.1 N
  EXPECT_GT(touch.lossTime(), 0);
}

TEST_F(TouchedSphere, TellsTheDishFromTheSideOfTheObject) {
  Touch side = touchWith(exactTouch()), dish = touchWith(exactTouch());
  Percept pushed = percept(0, Vec3::Zero()), lifted = pushed;
  pushed.fingers[0].f_D = Vec3(0, 0.2, -0.6);  // D: y up, z towards the object
  lifted.fingers[0].f_D = Vec3(0, 0.6, -0.2);
  for (int i = 0; i <= 100; ++i) {
    pushed.time = lifted.time = 1e-3 * i;
    side.feel(pushed);
    dish.feel(lifted);
  }
  EXPECT_FALSE(side.pushedFromBelow(random));
  EXPECT_EQ(dish.pushedFromBelow(random), 0);
}

}  // namespace
}  // namespace pincer::tasks
