#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pincer/tasks/lab/experiments/cylinder_judge.h"
#include "pincer/tasks/lab/experiments/cylinder_trial.h"
#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/participants/flat_belief.h"
#include "pincer/tests/support/memory_sink.h"

namespace pincer::tasks {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

TEST(CylinderJudge, CountsAsRegraspsOnlyGripsThatTurn) {
  CylinderJudge judge;
  CylinderView view;
  const auto play = [&](double seconds, double force, double turn) {
    for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
      view.time += 1e-3;
      view.normal_forces = {force, force};
      view.error += turn / (1000 * seconds);
      judge.observe(view);
    }
  };
  play(0.5, 1, 0);  // a probe
  play(0.3, 0, 0);
  play(0.5, 1, 0.5);  // turns
  play(0.05, 0, 0);   // too short to be a release
  play(0.5, 1, 0.5);
  play(0.3, 0, 0);
  play(0.5, 1, -0.3);  // turns again
  EXPECT_EQ(judge.counts().grips, 3);
  EXPECT_EQ(judge.counts().turning_grips, 2);
  EXPECT_EQ(judge.counts().regrasps(), 1);
}

TEST(CylinderJudge, EndsWithTheAnswerOrTheTime) {
  CylinderJudge judge({.timeout = 2});
  CylinderView view;
  view.on_flat = true;
  for (view.time = 0; view.time < 1; view.time += 1e-3) EXPECT_EQ(judge.observe(view), TrialVerdict::kRunning);
  EXPECT_NEAR(judge.counts().flat_time, 0.999, 2e-3);  // two ticks
  view.answers = true;
  EXPECT_EQ(judge.observe(view), TrialVerdict::kSuccess);
  view.answers = false;
  view.time = 2;
  EXPECT_EQ(judge.observe(view), TrialVerdict::kTimeout);
}

TEST(CylinderStarts, AreBalancedInSignAndWithinTheirRange) {
  const auto starts = startAngles({}, 10, 7);
  int positive = 0;
  for (const double angle : starts) {
    positive += angle > 0;
    EXPECT_GE(std::abs(angle), 0.7854);
    EXPECT_LE(std::abs(angle), 3.1416);
  }
  EXPECT_EQ(positive, 5);
}

// The cut circle against brute force: the nearest of many points of its outline.
TEST(CutCircleDistance, IsThatOfTheNearestPointOfTheOutline) {
  const FlatModel model;
  const double theta = 0.7, half_angle = std::acos(model.flat_distance / model.radius);
  std::vector<Vec2> outline;
  for (double a = half_angle; a <= 2 * std::numbers::pi - half_angle; a += 1e-4) {
    outline.push_back(model.radius * Vec2(std::cos(theta + a), std::sin(theta + a)));
  }
  const double chord = model.radius * std::sin(half_angle);
  for (double y = -chord; y <= chord; y += 1e-6) {
    outline.push_back(Eigen::Rotation2Dd(theta) * Vec2(model.flat_distance, y));
  }
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const double angle = random.uniform(-3, 3), rho = random.uniform(0.0205, 0.04);
    const Vec2 c = rho * Vec2(std::cos(angle), std::sin(angle));
    double nearest = 1;
    for (const Vec2& p : outline) nearest = std::min(nearest, (c - p).norm());
    EXPECT_NEAR(cutCircle(model, theta, c).distance, nearest, 3e-6);  // the outline's points are 2 um apart
  }
}

// Exact readings all around leave no doubt.
TEST(FlatBelief, FindsTheFlatFromExactReadings) {
  FlatModel model;
  model.placement_sd = model.placement_between_sd = 1e-4;
  Random random(5);
  FlatBelief belief;
  belief.begin(model, random);
  const double theta = 1.9;
  for (const double pinch : {-0.96, 0.0, 0.96, -0.5, 0.5}) {
    std::array<FlatPercept, 2> percept;
    for (std::size_t i = 0; i < 2; ++i) {
      const double at = pinch + (i == 0 ? std::numbers::pi : 0);
      double rho = model.radius + model.tip_radius;  // as near as the tip comes
      const auto gap = [&] {
        return cutCircle(model, theta, rho * Vec2(std::cos(at), std::sin(at))).distance - model.tip_radius;
      };
      for (int k = 0; k < 50; ++k) rho -= gap();
      percept[i].p_felt = rho * Vec2(std::cos(at), std::sin(at));
      percept[i].pad = i == 0 ? std::numbers::pi : 0;
      percept[i].push = cutCircle(model, theta, percept[i].p_felt).normal;
    }
    belief.observe(percept, random);
  }
  EXPECT_LT(std::abs(std::remainder(belief.direction() - theta, 2 * std::numbers::pi)), 10 * kDeg);
  EXPECT_LT(belief.spread(), 20 * kDeg);
}

SensingLimits sharpSenses() {
  SensingLimits limits;
  limits.tactor_sd = limits.orientation_sd = limits.direction_sd = limits.force_sd = 0;
  limits.placement_sd = limits.placement_between_sd = limits.span_sd = limits.target_shared_sd =
      limits.target_trial_sd = 0;
  return limits;
}

ManipulationStudy alignments(const SensingLimits& limits, bool pivot = true) {
  ManipulationStudy study;
  study.participants = 1;
  study.tasks = {HandTask::kAlignment};
  study.training.alignments = 0;
  study.alignment.repetitions = 2;
  study.alignment.pivot = pivot;
  study.conditions = {publishedHandConditions()[1]};
  study.people.limits = limits;
  return study;
}

const std::atomic<bool> kOn{false};

TEST(CylinderAlignment, IsDoneWellBySharpSenses) {
  tests::MemorySink sink;
  runManipulationStudy(alignments(sharpSenses()), {}, sink, kOn);
  ASSERT_EQ(sink.trials.size(), 2u);
  for (const TrialRecord& trial : sink.trials) {
    EXPECT_EQ(trial.outcome, "success");
    // far less than the 45 .. 180 degrees of the start
    EXPECT_LT(std::abs(trial.error), 20 * kDeg) << trial.start_angle;
    EXPECT_GT(trial.flat_time, 0);
  }
  EXPECT_FALSE(sink.readings.empty());
}

TEST(CylinderAlignment, OfAFreeCylinderEndsWithoutAFault) {
  tests::MemorySink sink;
  ManipulationStudy study = alignments({}, false);
  study.alignment.timeout = 20;
  runManipulationStudy(study, {}, sink, kOn);
  for (const TrialRecord& trial : sink.trials) EXPECT_NE(trial.outcome, "fault");
}

}  // namespace
}  // namespace pincer::tasks
