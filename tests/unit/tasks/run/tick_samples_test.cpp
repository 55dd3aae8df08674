// The tick as a function of model, state and samples: its purity, its frames, and what it
// does with samples that can't be trusted.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "pincer/engine/state.h"
#include "pincer/tasks/run/tick/tick.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::tasks {
namespace {

using tests::kNan;

constexpr double kTick = 1e-3;

// Two arms, turned differently, whose fingers pinch a ball of 50 g. Gates without ramp, so that forces come at once.
struct Rig {
  TickModel model;
  TickState state;

  Rig() {
    tests::GraspWorld ball = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3);
    model.grasp = ball.model;
    state.grasp = ball.state;
    for (int i = 0; i < 2; ++i) {
      FingerMount mount;
      mount.X_WD = {Quat(Eigen::AngleAxisd(0.7 + i, Vec3(1, 2, -1).normalized())), Vec3(0.2 * i, -0.1, 0.3)};
      mount.gate.ramp_time = 0;
      model.mounts.push_back(mount);
    }
    state.mounts.resize(2);
    for (MountState& mount : state.mounts) devices::arm(mount.gate);
  }
};

// Samples of the arms when the fingers squeeze, lift and wiggle; the second arm also measures its velocity.
std::vector<FingerInputs> samplesAt(const TickModel& model, int tick) {
  const double t = kTick * tick, squeeze = 2e-3 * std::min(1.0, t / 0.05), lift = 5e-3 * std::sin(20 * t);
  std::vector<FingerInputs> samples(2);
  for (std::size_t i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1;
    const Pose& X_WD = model.mounts[i].X_WD;
    devices::ArmSample& arm = samples[i].arm;
    arm.time = t;
    arm.valid = true;
    arm.p_DF = X_WD.inverse() * Vec3(side * (0.028 - squeeze), 1e-3 * std::sin(31 * t), 0.1 + lift);
    arm.q_DF = Quat(Eigen::AngleAxisd(0.1 * std::sin(7 * t), Vec3::UnitY()));
    if (i == 1) arm.v_DF = X_WD.q.conjugate() * Vec3(0, 0.031 * std::cos(31 * t), 0.1 * std::cos(20 * t));
  }
  return samples;
}

using AllInputs = std::vector<std::vector<FingerInputs>>;

AllInputs record(const TickModel& model, int first, int ticks) {
  AllInputs recording;
  for (int k = first; k < first + ticks; ++k) recording.push_back(samplesAt(model, k));
  return recording;
}

struct Trace {
  std::vector<std::uint64_t> hashes;
  std::vector<double> outputs;  // forces and tactor places, bit by bit what went to the devices

  bool operator==(const Trace& other) const {
    return hashes == other.hashes && outputs.size() == other.outputs.size() &&
           std::memcmp(outputs.data(), other.outputs.data(), outputs.size() * sizeof(double)) == 0;
  }
};

Trace play(const TickModel& model, TickState& state, const AllInputs& recording, int first) {
  TickScratch scratch(model);
  Trace trace;
  for (std::size_t k = 0; k < recording.size(); ++k) {
    tick(model, state, scratch, recording[k], kTick * (first + static_cast<int>(k)));
    trace.hashes.push_back(engine::hashOf(state.grasp.world));
    for (const FingerOutputs& out : scratch.outputs) {
      for (const double x : {out.f_D.x(), out.f_D.y(), out.f_D.z(), out.tactile.place_L.x(), out.tactile.place_L.y()})
        trace.outputs.push_back(x);
    }
  }
  return trace;
}

// A pinched ball's tick by tick life, for tests of a single finger's trouble.
struct LiveRig : Rig {
  TickScratch scratch{model};
  int next = 0;

  void run(int ticks) {
    for (int k = 0; k < ticks; ++k) step(samplesAt(model, next));
  }
  engine::StepReport step(const std::vector<FingerInputs>& samples) {
    return tick(model, state, scratch, samples, kTick * next++);
  }
  Vec3 force(std::size_t finger) const { return scratch.outputs[finger].f_D; }
};

TEST(Tick, GivesTheSameBitsForTheSameSamples) {
  Rig a, b;
  const AllInputs recording = record(a.model, 0, 400);
  const Trace first = play(a.model, a.state, recording, 0);
  EXPECT_EQ(first, play(b.model, b.state, recording, 0));
  EXPECT_NE(first.hashes.front(), first.hashes.back());  // something happened
}

TEST(Tick, ReplaysARecordingFromASnapshot) {
  Rig rig;
  play(rig.model, rig.state, record(rig.model, 0, 150), 0);
  TickState snapshot = rig.state;
  const AllInputs rest = record(rig.model, 150, 300);
  const Trace live = play(rig.model, rig.state, rest, 150);
  EXPECT_EQ(live, play(rig.model, snapshot, rest, 150));  // with a scratch of its own: nothing is remembered there
}

// One bit of one sample shows in the outcome: the equalities above aren't those of a tick that ignores its input.
TEST(Tick, TellsSamplesApartByOneBit) {
  Rig a, b;
  const AllInputs recording = record(a.model, 0, 300);
  AllInputs nudged = recording;
  double& x = nudged[200][0].arm.p_DF.x();
  x = std::nextafter(x, 1);
  const Trace first = play(a.model, a.state, recording, 0), second = play(b.model, b.state, nudged, 0);
  EXPECT_EQ(first.hashes[199], second.hashes[199]);
  EXPECT_NE(first.hashes[200], second.hashes[200]);
}

TEST(Tick, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "the sanitizer owns the allocator";
  LiveRig rig;
  const AllInputs recording = record(rig.model, 0, 500);
  rig.step(recording[0]);
  const auto before = tests::allocationCount();
  for (std::size_t k = 1; k < recording.size(); ++k) rig.step(recording[k]);
  EXPECT_EQ(tests::allocationCount() - before, 0);
}

TEST(Tick, PlacesTheProxyWhereTheFirstValidSampleIs) {
  LiveRig rig;
  for (MountState& mount : rig.state.mounts) mount.gate = {};  // nobody has armed yet
  const Vec3 start_W = rig.state.grasp.world.points[0].p_W, p_WF(0.05, 0.2, 0.3);
  std::vector<FingerInputs> samples = samplesAt(rig.model, 0);
  samples[0].arm.valid = false;
  rig.step(samples);
  EXPECT_EQ(rig.state.grasp.world.points[0].p_W, start_W);  // not heard of yet
  EXPECT_FALSE(rig.state.mounts[0].seen);
  samples = samplesAt(rig.model, 1);
  samples[0].arm.p_DF = rig.model.mounts[0].X_WD.inverse() * p_WF;
  rig.step(samples);
  EXPECT_TRUE(rig.state.mounts[0].seen);
  // A jump of 0.3 m, yet no pull (coupling: 1000 N/m) and no speed. Rounding of X_WD and its inverse: a few ulp of 1 m.
  EXPECT_LE((rig.state.grasp.world.points[0].p_W - p_WF).norm(), 1e-15);
  EXPECT_LE(rig.scratch.fingers[0].f_user_W.norm(), 1e-12);
  EXPECT_EQ(rig.state.mounts[0].v_WF, Vec3::Zero());
}

TEST(Tick, RendersTheFingersForceInTheArmsFrame) {
  LiveRig rig;
  for (FingerMount& mount : rig.model.mounts) mount.gate.slew = 1e6;  // the gate stands wide open
  rig.run(200);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 f_W = rig.scratch.fingers[i].f_user_W;
    EXPECT_GT(f_W.norm(), 0.5);
    EXPECT_LE((rig.model.mounts[i].X_WD.q * rig.force(i) - f_W).norm(), 1e-14 * f_W.norm());  // two rotations' rounding
  }
  EXPECT_LT(rig.scratch.fingers[0].f_user_W.x(), -0.5);  // out of the ball
  EXPECT_GT(rig.scratch.fingers[1].f_user_W.x(), 0.5);
}

// First-order low-pass of a measured velocity that jumps to v: after n ticks v (1 - exp(-2 pi f n dt)).
TEST(Tick, FiltersAMeasuredVelocityAsAFirstOrderLowPass) {
  LiveRig rig;
  const Vec3 v_D(0.1, -0.2, 0.05);
  for (int n = 0; n <= 20; ++n) {
    std::vector<FingerInputs> samples = samplesAt(rig.model, n);
    samples[0].arm.v_DF = v_D;
    rig.step(samples);
    const double share = -std::expm1(-2 * std::numbers::pi * rig.model.velocity_cutoff * kTick * n);
    // 20 updates' rounding
    EXPECT_LE((rig.state.mounts[0].v_WF - share * (rig.model.mounts[0].X_WD.q * v_D)).norm(), 1e-14) << n;
  }
}

TEST(Tick, DifferencesPositionsWhereTheArmMeasuresNoVelocity) {
  LiveRig rig;
  const Vec3 v_D(0.1, -0.2, 0.05);
  std::vector<FingerInputs> samples = samplesAt(rig.model, 0);
  const Vec3 start_D = samples[0].arm.p_DF;
  for (int n = 0; n <= 100; ++n) {
    samples = samplesAt(rig.model, n);
    samples[0].arm.p_DF = start_D + kTick * n * v_D;
    rig.step(samples);
  }
  const Vec3 v_W = rig.model.mounts[0].X_WD.q * v_D;
  // exp(-2 pi 60 Hz 0.1 s) = 4e-17; positions of 0.3 m are rounded to 6e-17 m, differenced over 1 ms: 1e-13 m/s.
  EXPECT_LE((rig.state.mounts[0].v_WF - v_W).norm(), 1e-12);
}

struct Trouble {
  const char* name;
  devices::Trip cause;
  void (*spoil)(devices::ArmSample&);
};

class TickTrouble : public ::testing::TestWithParam<Trouble> {};

TEST_P(TickTrouble, MeansZeroForceUntilArmedAgain) {
  LiveRig rig;
  rig.run(200);
  ASSERT_GT(rig.force(0).norm(), 0.5);
  std::vector<FingerInputs> samples = samplesAt(rig.model, rig.next);
  GetParam().spoil(samples[0].arm);
  const engine::StepReport report = rig.step(samples);
  EXPECT_EQ(report.status & (engine::kStateNotFinite | engine::kInputNotFinite), 0u);  // the world never sees it
  EXPECT_EQ(rig.force(0), Vec3::Zero());
  EXPECT_EQ(rig.state.mounts[0].gate.trip, GetParam().cause);
  EXPECT_GT(rig.force(1).norm(), 0.5);  // the other arm is sound
  for (int k = 0; k < 100; ++k) {
    rig.run(1);
    ASSERT_EQ(rig.force(0), Vec3::Zero()) << "good samples alone don't arm";
  }
  EXPECT_EQ(rig.state.mounts[0].gate.trip, GetParam().cause);
  devices::arm(rig.state.mounts[0].gate);
  rig.run(50);
  EXPECT_GT(rig.force(0).norm(), 0.5) << "once armed it works as before";
}

std::string nameOfTrouble(const ::testing::TestParamInfo<Trouble>& info) { return info.param.name; }

using devices::ArmSample;
using devices::Trip;
INSTANTIATE_TEST_SUITE_P(
    OfEveryKind, TickTrouble,
    ::testing::Values(Trouble{"NanPosition", Trip::kNotFinite, [](ArmSample& s) { s.p_DF.y() = kNan; }},
                      Trouble{"NanVelocity", Trip::kNotFinite, [](ArmSample& s) { s.v_DF = Vec3(0, kNan, 0); }},
                      Trouble{"NanOrientation", Trip::kNotFinite, [](ArmSample& s) { s.q_DF->w() = kNan; }},
                      Trouble{"NanTime", Trip::kNotFinite, [](ArmSample& s) { s.time = kNan; }},
                      Trouble{"InfinitePosition", Trip::kNotFinite, [](ArmSample& s) { s.p_DF.z() = HUGE_VAL; }},
                      Trouble{"Invalid", Trip::kInvalidSample, [](ArmSample& s) { s.valid = false; }},
                      Trouble{"InvalidAndNan", Trip::kInvalidSample,
                              [](ArmSample& s) {
                                s = {};
                                s.p_DF.setConstant(kNan);
                              }},
                      Trouble{"Stale", Trip::kStaleSample, [](ArmSample& s) { s.time -= 4e-3; }},
                      Trouble{"FromTheFuture", Trip::kStaleSample, [](ArmSample& s) { s.time += 4e-3; }},
                      Trouble{"OverSpeed", Trip::kOverSpeed, [](ArmSample& s) { s.v_DF = Vec3(7, 0, 0); }}),
    nameOfTrouble);

// A device that fell silent repeats its last sample.
TEST(Tick, CutsTheForceWhenAnArmFallsSilent) {
  LiveRig rig;
  rig.run(200);
  const devices::ArmSample last = samplesAt(rig.model, rig.next - 1)[0].arm;
  for (int k = 0; k < 5; ++k) {
    std::vector<FingerInputs> samples = samplesAt(rig.model, rig.next);
    samples[0].arm = last;
    rig.step(samples);
  }
  EXPECT_EQ(rig.force(0), Vec3::Zero());
  EXPECT_EQ(rig.state.mounts[0].gate.trip, devices::Trip::kStaleSample);
}

TEST(Tick, ParksTheTactorInTheForceOnlyCondition) {
  LiveRig rig;
  rig.model.mounts[0].display_tactile = false;
  rig.run(200);
  EXPECT_TRUE(rig.scratch.outputs[0].tactile.parked);
  EXPECT_FALSE(rig.scratch.outputs[1].tactile.parked);
}

// Passivity observes what the gate let through, in the world's frame, whatever the arms' frames are.
TEST(Tick, PassivityCountsTheForceThatTheGateLetThrough) {
  LiveRig rig;
  rig.state.passivity = grasp::PassivityState(2);
  double energy = 0;
  std::array<Vec3, 2> held_W = {Vec3::Zero(), Vec3::Zero()}, last_W = held_W;
  for (int k = 0; k < 300; ++k) {
    const std::vector<FingerInputs> samples = samplesAt(rig.model, rig.next);
    rig.step(samples);
    for (std::size_t i = 0; i < 2; ++i) {
      const Pose& X_WD = rig.model.mounts[i].X_WD;
      const Vec3 p_W = X_WD * samples[i].arm.p_DF;
      if (k > 0) energy -= held_W[i].dot(p_W - last_W[i]);
      last_W[i] = p_W;
      held_W[i] = X_WD.q * rig.force(i);
    }
  }
  EXPECT_GT(std::abs(energy), 1e-4);
  EXPECT_NEAR(rig.state.passivity.energy(), energy, 1e-12);
}

// Off, but watching, nothing that reaches a motor changes by a bit; on, fingers that take out what they never brought
// in (here the ball's height, as they let it down from where it began) are braked.
TEST(Tick, PassivityChangesForcesOnlyWhereItIsOn) {
  Rig plain, watched, braked;
  watched.state.passivity = braked.state.passivity = grasp::PassivityState(2);
  braked.model.passivity.on = true;
  AllInputs recording = record(plain.model, 0, 400);
  for (std::vector<FingerInputs>& samples : recording) {
    for (std::size_t i = 0; i < 2; ++i) {
      samples[i].arm.p_DF -= plain.model.mounts[i].X_WD.q.conjugate() * Vec3(0, 0, 0.1 * samples[i].arm.time);
    }
  }
  const Trace reference = play(plain.model, plain.state, recording, 0);
  EXPECT_EQ(play(watched.model, watched.state, recording, 0), reference);
  EXPECT_FALSE(play(braked.model, braked.state, recording, 0) == reference);
  EXPECT_GT(braked.state.passivity.acted, 0);
}

// Late samples, led on: the world sees the finger where it would be by now.
TEST(Tick, LeadsLateSamplesOnWithAFirstOrderHold) {
  LiveRig held, led;
  led.model.pose_hold = PoseHold::kFirst;
  for (LiveRig* rig : {&held, &led}) {
    rig->run(200);
    std::vector<FingerInputs> samples = samplesAt(rig->model, rig->next);
    for (FingerInputs& s : samples) s.arm.time -= 2e-3;  // two ticks old when it comes
    rig->step(samples);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 raw_W = held.state.mounts[i].p_WF;
    EXPECT_EQ(held.scratch.inputs[i].p_WF, raw_W);
    EXPECT_LT((led.scratch.inputs[i].p_WF - raw_W - 2e-3 * led.state.mounts[i].v_WF).norm(), 1e-12);
  }
}

// A gimbal that is silent for a tick hasn't turned back to the arm's own axes.
TEST(Tick, KeepsTheOrientationThatWasReadLast) {
  LiveRig rig;
  rig.run(200);
  const Quat before = rig.scratch.inputs[0].q_WF;
  std::vector<FingerInputs> samples = samplesAt(rig.model, rig.next);
  samples[0].arm.q_DF.reset();
  rig.step(samples);
  EXPECT_LT(angleBetween(rig.scratch.inputs[0].q_WF, before), 1e-9);
  EXPECT_GT(angleBetween(before, rig.model.mounts[0].X_WD.q), 0.01);
}

}  // namespace
}  // namespace pincer::tasks
