#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/lab/experiments/pickup_judge.h"

namespace pincer::tasks {
namespace {

constexpr double kJudgeTick = 1e-3;

// Plays scripted states to a judge.
struct Stage {
  PickupJudge judge;
  PickupView view;
  TrialVerdict verdict = TrialVerdict::kRunning;

  Stage() {
    for (std::size_t i = 0; i < 2; ++i) view.fingers[i].p_WC = Vec3(i == 0 ? -0.02 : 0.02, 0, 0.02);
    view.p_WBcm = Vec3(0, 0, 0.02);
  }
  void grip(double force) {
    for (auto& finger : view.fingers) {
      finger.on_object = force > 0;
      finger.normal_force = force;
    }
  }
  void play(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds / kJudgeTick));
    for (int i = 0; i < ticks && verdict == TrialVerdict::kRunning; ++i) {
      verdict = judge.observe(view);
      view.time += kJudgeTick;
    }
  }
  const PickupCounts& counts() const { return judge.counts(); }
};

TEST(PickupJudge, CountsASqueezeOnlyWithIntentAndBothFingers) {
  Stage stage;
  stage.grip(1);
  stage.play(0.1);
  EXPECT_EQ(stage.counts().squeezes, 0);  // no intent
  stage.view.wants_lift = true;
  stage.view.fingers[1].normal_force = 0.2;
  stage.play(0.1);
  EXPECT_EQ(stage.counts().squeezes, 0);  // one finger at 0.2 N, not above
  stage.view.fingers[1].normal_force = 0.21;
  stage.play(0.1);
  EXPECT_EQ(stage.counts().squeezes, 1);
}

TEST(PickupJudge, CountsOneSqueezePerAttempt) {
  Stage stage;
  stage.view.wants_lift = true;
  for (int ring = 0; ring < 5; ++ring) {  // forces that ring for less than 0.1 s are the same squeeze
    stage.grip(1);
    stage.play(0.05);
    stage.grip(0);
    stage.play(0.05);
  }
  EXPECT_EQ(stage.counts().squeezes, 1);
  stage.play(0.1);
  stage.grip(1);
  stage.play(0.05);
  EXPECT_EQ(stage.counts().squeezes, 2);  // it was released
  stage.view.wants_lift = false;
  stage.play(0.01);
  stage.view.wants_lift = true;
  stage.play(0.01);
  EXPECT_EQ(stage.counts().squeezes, 3);  // a new intent
}

TEST(PickupJudge, MeasuresTheOffsetFromTheLineThroughTheContacts) {
  Stage stage;
  stage.view.wants_lift = true;
  EXPECT_TRUE(std::isnan(stage.counts().offset_at_squeeze));
  // the shift along the line doesn't count
  for (auto& finger : stage.view.fingers) finger.p_WC += Vec3(0.001, 0.003, -0.004);
  stage.grip(1);
  stage.play(0.01);
  EXPECT_NEAR(stage.counts().offset_at_squeeze, 0.005, 1e-15);
}

TEST(PickupJudge, CountsALiftWhenTheObjectLeavesTheDishAndATryWhenItClears5mm) {
  Stage stage;
  stage.grip(1);
  stage.view.clearance = 4e-3;
  stage.play(0.2);
  EXPECT_EQ(stage.counts().lifts, 1);
  stage.view.clearance = 0;
  stage.play(0.2);
  EXPECT_EQ(stage.counts().tries_5mm, 0);
  stage.view.clearance = 6e-3;
  stage.play(0.2);
  EXPECT_EQ(stage.counts().lifts, 2);
  EXPECT_EQ(stage.counts().tries_5mm, 1);
  stage.view.clearance = 1e-3;  // not back yet
  stage.play(0.2);
  stage.view.clearance = 6e-3;  // so this is the same one
  stage.play(0.2);
  EXPECT_EQ(stage.counts().lifts, 2);
  EXPECT_EQ(stage.counts().tries_5mm, 1);
  EXPECT_EQ(stage.counts().drops, 0);  // the fingers never left it
}

TEST(PickupJudge, SaysHowASqueezeFailed) {
  Stage stage;
  const auto squeezeTo = [&](double clearance, double aside) {
    stage.view.wants_lift = true;
    stage.grip(1);
    stage.play(0.05);
    stage.view.clearance = clearance;
    stage.view.p_WBcm.y() += aside;
    stage.play(0.05);
    stage.grip(0);
    stage.play(0.2);
    stage.view.clearance = 0;
    stage.view.wants_lift = false;
    stage.play(0.05);
    return std::string(stage.counts().last_failure);
  };
  EXPECT_EQ(squeezeTo(0, 0), "not lifted");
  EXPECT_EQ(squeezeTo(2e-3, 0), "slipped");
  EXPECT_EQ(squeezeTo(2e-3, 8e-3), "squeezed out");
  EXPECT_EQ(squeezeTo(9e-3, 0), "dropped");
  EXPECT_EQ(stage.counts().failures, 4);
}

TEST(PickupJudge, IgnoresTheJitterOfAnObjectOnTheDish) {
  Stage stage;
  for (int i = 0; i < 100; ++i) {
    stage.view.clearance = i % 2 == 0 ? 2e-4 : -1e-5;
    stage.play(0.01);
  }
  EXPECT_EQ(stage.counts().lifts, 0);
}

TEST(PickupJudge, CountsADropWhenNothingHoldsTheObject) {
  Stage stage;
  stage.grip(1);
  stage.view.clearance = 10e-3;
  stage.play(0.1);
  stage.view.fingers[0].on_object = false;
  stage.play(0.01);
  EXPECT_EQ(stage.counts().drops, 0);  // one finger still touches
  stage.grip(0);
  stage.play(0.01);
  EXPECT_EQ(stage.counts().drops, 1);
  stage.view.clearance = 0;
  stage.play(0.01);
  EXPECT_EQ(stage.counts().drops, 1);
  EXPECT_EQ(stage.counts().tries_5mm, 1);
}

TEST(PickupJudge, CountsNoDropForAnObjectThatJumpsOutOfTheFingersUnder5mm) {
  Stage stage;
  stage.grip(1);
  stage.view.clearance = 3e-3;
  stage.play(0.1);
  stage.grip(0);
  stage.play(0.01);
  stage.view.clearance = 8e-3;  // thrown, never held up there
  stage.play(0.01);
  EXPECT_EQ(stage.counts().drops, 0);
}

TEST(PickupJudge, CountsASlipOnceItIsASlipOfALoadedFinger) {
  Stage stage;
  stage.grip(1);
  auto& finger = stage.view.fingers[0];
  finger.slide_speed = 0.01;
  stage.play(0.05);  // sticks (a speed that the engine calls sticking doesn't count)
  finger.sliding = true;
  stage.play(0.015);
  EXPECT_EQ(stage.counts().slips, 0);  // 0.15 mm so far
  stage.play(0.5);
  EXPECT_EQ(stage.counts().slips, 1);  // one slide, one slip
  finger.sliding = false;
  stage.play(0.05);
  finger.sliding = true;
  stage.play(0.05);
  EXPECT_EQ(stage.counts().slips, 2);
}

TEST(PickupJudge, CountsNoSlipOfALightFingerOrOneThatNeverStuck) {
  Stage stage;
  for (auto& finger : stage.view.fingers) {
    finger.on_object = finger.sliding = true;
    finger.slide_speed = 0.1;
  }
  stage.view.fingers[0].normal_force = 0.19;
  stage.view.fingers[1].normal_force = 1;  // lands sliding
  stage.play(0.5);
  EXPECT_EQ(stage.counts().slips, 0);
}

TEST(PickupJudge, CallsItASuccessAfterOneSecondAbove50mm) {
  Stage stage;
  stage.grip(2);
  stage.view.clearance = 0.051;
  stage.play(0.9);
  stage.view.clearance = 0.049;  // sinks: the second begins anew
  stage.play(0.1);
  stage.view.clearance = 0.051;
  stage.grip(1.5);
  stage.play(0.99);
  EXPECT_EQ(stage.verdict, TrialVerdict::kRunning);
  EXPECT_TRUE(std::isnan(stage.counts().held_grip));
  stage.play(0.1);
  EXPECT_EQ(stage.verdict, TrialVerdict::kSuccess);
  EXPECT_NEAR(stage.counts().held_grip, 1.5, 1e-12);
  EXPECT_NEAR(stage.counts().peak_grip, 2, 0);
}

TEST(PickupJudge, EndsATrialAfter60s) {
  Stage stage;
  stage.play(59.9);
  EXPECT_EQ(stage.verdict, TrialVerdict::kRunning);
  stage.play(0.2);
  EXPECT_EQ(stage.verdict, TrialVerdict::kTimeout);
  EXPECT_NEAR(stage.view.time, 60, 2e-3);
}

}  // namespace
}  // namespace pincer::tasks
