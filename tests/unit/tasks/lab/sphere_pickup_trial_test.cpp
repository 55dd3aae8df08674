#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "pincer/contact/surface/patch_cache.h"
#include "pincer/tasks/lab/experiments/manipulation_study.h"
#include "pincer/tasks/lab/experiments/pickup_trial.h"
#include "pincer/tasks/lab/experiments/simulated_trial.h"
#include "pincer/tasks/lab/participants/scripted_pickup.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/memory_sink.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kTicks = 70000;  // of the longest trial

// Senses without error: such a participant pinches the sphere where it is.
SensingLimits exactSenses() {
  SensingLimits limits;
  limits.tactor_sd = limits.orientation_sd = limits.placement_sd = limits.placement_between_sd = limits.direction_sd =
      limits.force_sd = 0;
  return limits;
}

PickupTrialSpec specWith(double mu, const HandCondition& condition = publishedHandConditions()[1]) {
  return {0, 0, 0, condition, mu, 0.85 * mu, 4};
}

struct PickupRun {
  SpherePickupOptions options;
  PickupObject object = makePickupObject(options);
  ScriptedPickup participant;
  tests::MemorySink sink{kTicks};
  SimulatedTrial cycle;
  std::atomic<bool> interrupted{false};

  explicit PickupRun(const PickupTrialSpec& spec, const SensingLimits& limits = exactSenses())
      : participant(1, {}, limits), cycle(std::make_unique<PickupTrial>(options, object, spec, sink), participant) {}
  const TrialRecord& run() {
    runServo({}, cycle, interrupted);
    cycle.finish();
    return sink.trials.front();
  }
};

TEST(SpherePickupTrial, PicksUpARoughSphereAtTheFirstTry) {
  PickupRun run(specWith(0.9));
  const TrialRecord& row = run.run();
  EXPECT_EQ(row.outcome, "success");
  EXPECT_EQ(row.condition, "cld+force");
  EXPECT_EQ(row.squeezes, 1);
  EXPECT_EQ(row.drops, 0);
  EXPECT_LT(row.duration, 10);
  // Held by friction: the grip is at least m g/(2 mu).
  EXPECT_GT(row.grip_ratio, 1);
  EXPECT_LT(row.offset_at_squeeze, 5e-3);  // less than what is worth a shift
  EXPECT_EQ(run.sink.count("success"), 1);
  EXPECT_EQ(run.sink.count("squeeze"), 1);
}

TEST(SpherePickupTrial, HoldsTheSphere50mmUpForTheLastSecond) {
  PickupRun run(specWith(0.6));
  const TrialRecord& row = run.run();
  ASSERT_EQ(row.outcome, "success");
  double start = -1;
  for (const auto& event : run.sink.events) {
    if (event.kind == "tone" && event.detail == "start") start = event.time;
  }
  const double end = start + row.duration;
  int held = 0;
  for (const auto& sample : run.sink.samples) {
    if (sample.time < end - 1 || sample.time > end) continue;
    ++held;
    // the dish is curved: a bottom 1 mm off its middle is 3 um higher
    EXPECT_GE(sample.p_WB[2], run.options.radius + 0.050 - 1e-4);
  }
  EXPECT_GE(held, 1000);  // a sample per tick
}

TEST(SpherePickupTrial, PicksUpASphereWithOrdinarySensesWithinTheTimeOut) {
  PickupRun run(specWith(0.9), {});
  EXPECT_EQ(run.run().outcome, "success");
}

TEST(SpherePickupTrial, RepeatsItselfToTheBit) {
  PickupRun first(specWith(0.45), {}), second(specWith(0.45), {});
  first.run();
  second.run();
  ASSERT_EQ(first.sink.samples.size(), second.sink.samples.size());
  for (std::size_t i = 0; i < first.sink.samples.size(); ++i) {
    SampleRecord a = first.sink.samples[i], b = second.sink.samples[i];
    ASSERT_EQ(std::memcmp(&a.p_WB, &b.p_WB, sizeof a.p_WB + sizeof a.q_WB + sizeof a.v_WB), 0) << "tick " << i;
    for (std::size_t finger = 0; finger < a.fingers.size(); ++finger) {
      ASSERT_EQ(a.fingers[finger].p_WP, b.fingers[finger].p_WP) << "tick " << i;
      ASSERT_EQ(a.fingers[finger].f_arm_D, b.fingers[finger].f_arm_D) << "tick " << i;
    }
  }
}

TEST(SpherePickupTrial, ParksTheTactorsInTheForceOnlyCondition) {
  PickupRun parked(specWith(0.9, publishedHandConditions()[0])), shown(specWith(0.9));
  parked.run();
  shown.run();
  double moved = 0;
  for (const auto& sample : parked.sink.samples) {
    for (const auto& finger : sample.fingers) {
      EXPECT_NE(finger.flags & 8, 0);
      EXPECT_EQ(finger.place_shown_L[0], 0);
    }
  }
  for (const auto& sample : shown.sink.samples) moved = std::max(moved, std::abs(sample.fingers[0].place_shown_L[1]));
  EXPECT_GT(moved, 1e-3);  // on the way down to the sphere its nearest point lies low on the pad
}

TEST(SpherePickupTrial, EndsInAFaultWithZeroForceWhenAnArmIsUnplugged) {
  PickupRun run(specWith(0.9));
  double now = 0;
  for (; now < 4.5; now += 1e-3) ASSERT_TRUE(run.cycle.tick(now));
  run.cycle.hands().arm(0).setFault(devices::SimFault::kUnplugged);
  bool more = true;
  for (int i = 0; i < 5 && more; ++i, now += 1e-3) more = run.cycle.tick(now);
  EXPECT_FALSE(more);
  for (const auto& output : run.cycle.trial().outputs()) EXPECT_EQ(output.f_D, Vec3::Zero());
  run.cycle.finish();
  EXPECT_EQ(run.sink.trials.front().outcome, "fault");
  EXPECT_EQ(run.sink.count("gate_trip"), 1);
}

TEST(SpherePickupTrial, AllocatesNothingPerTick) {
  PickupRun run(specWith(0.9));
  for (int i = 0; i < 100; ++i) run.cycle.tick(1e-3 * i);
  const auto before = tests::allocationCount();
  for (int i = 100; i < 6000; ++i) run.cycle.tick(1e-3 * i);
  EXPECT_EQ(tests::allocationCount() - before, 0);
}

TEST(SpherePickupTrial, MeasuresTheClearanceOfASphereLiftedStraightUp) {
  const SpherePickupOptions options;
  const HandScene scene = makePickupScene(options, makePickupObject(options), specWith(0.5));
  contact::PatchCache patches;
  for (const double height : {0.0, 0.001, 0.05, 0.08}) {
    EXPECT_NEAR(clearanceOverDish(scene, {Quat::Identity(), Vec3(0, 0, options.radius + height)}, patches), height,
                1e-15);
  }
}

ManipulationStudy shortStudyOfBoth() {
  ManipulationStudy study;
  study.participants = 1;
  study.training = {0, 0};
  study.pickup.frictions = {0.9};
  study.pickup.repetitions = study.alignment.repetitions = 1;
  study.pickup.timeout = study.alignment.timeout = 8;
  return study;
}

TEST(ManipulationStudy, RunsBothTasksInOneConditionThenInTheOtherAndReportsProgress) {
  tests::MemorySink sink;
  std::vector<std::size_t> done;
  const std::atomic<bool> interrupted{false};
  const auto progress = [&](const TrialProgress& at) { done.push_back(at.done); };
  EXPECT_EQ(runManipulationStudy(shortStudyOfBoth(), {}, sink, interrupted, {{}, progress, {}}), 4u);
  EXPECT_EQ(done, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  ASSERT_EQ(sink.trials.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(sink.trials[i].condition, i < 2 ? "force" : "cld+force");
    EXPECT_EQ(sink.trials[i].task, i % 2 == 0 ? "sphere-pickup" : "cylinder-alignment");
  }
}

TEST(ManipulationStudy, LeavesNoRowOfAnInterruptedTrial) {
  tests::MemorySink sink;
  const std::atomic<bool> interrupted{true};
  EXPECT_EQ(runManipulationStudy({}, {}, sink, interrupted), 0u);
  EXPECT_TRUE(sink.trials.empty());
}

// Finished trials are left alone, and the rest comes out as if nothing had happened.
TEST(ManipulationStudy, GoesOnWhereItWasStopped) {
  const ManipulationStudy study = shortStudyOfBoth();
  const std::atomic<bool> interrupted{false};
  tests::MemorySink whole, rest;
  runManipulationStudy(study, {}, whole, interrupted);
  EXPECT_EQ(runManipulationStudy(study, {}, rest, interrupted, {{0, 2}, {}, {}}), 4u);
  ASSERT_EQ(rest.trials.size(), 2u);
  EXPECT_EQ(rest.trials[0].trial, 1);
  EXPECT_EQ(rest.trials[0].error, whole.trials[1].error);
  EXPECT_EQ(rest.trials[1].duration, whole.trials[3].duration);
}

// Passivity took an arm of 50 g without friction for whichever arm held the finger.
TEST(SpherePickupTrial, PassivityBuildsOnWhatTheArmTellsOfItsTip) {
  PickupRun run(specWith(0.9));
  devices::ArmCapabilities heavy;
  heavy.tip_mass = 0.2;
  heavy.tip_damping = 0.5;
  run.cycle.trial().fitTo(1, heavy);
  const grasp::PassivityOptions& options = run.cycle.trial().scene().model.passivity;
  ASSERT_EQ(options.arms.size(), 2u);
  EXPECT_EQ(options.arms[0].mass, grasp::ArmPort{}.mass) << "that arm doesn't tell";
  EXPECT_EQ(options.arms[1].mass, 0.2);
  EXPECT_EQ(options.arms[1].damping, 0.5);
}

// The joints' torques were no limit of any session's gate.
TEST(SpherePickupTrial, TheGateKeepsToTheTorquesOfTheArms) {
  PickupRun run(specWith(0.9));
  EXPECT_EQ(run.cycle.trial().scene().model.mounts[0].gate.peak_torque, run.cycle.hands().arm(0).peakTorque());
  devices::ArmCapabilities weak;
  weak.peak_torque = Vec3(0.2, 0.2, 0.1);
  for (int i = 0; i < kHandFingers; ++i) run.cycle.trial().fitTo(i, weak);
  double most = 0;
  for (int tick = 0; tick < 9000; ++tick) {
    run.cycle.tick(1e-3 * tick);
    const std::vector<FingerInputs>& samples = run.cycle.hands().sample();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 torque = samples[i].arm.J->transpose() * run.cycle.trial().outputs()[i].f_D;
      most = std::max(most, torque.cwiseQuotient(*weak.peak_torque).cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LE(most, 1 + 1e-12);
  EXPECT_GT(most, 0.99) << "the pinch must have asked for more";
}

}  // namespace
}  // namespace pincer::tasks
