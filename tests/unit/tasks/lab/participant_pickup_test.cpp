#include <gtest/gtest.h>

#include <cstring>

#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/lab/participants/scripted_pickup.h"
#include "pincer/tests/support/allocation_guard.h"

namespace pincer::tasks {
namespace {

// A world made of nothing but percepts: fingers that follow the hand, and a push against the pads when the fingertips
// are closer than `width`, as stiff as `stiffness`.
struct Phantom {
  HandScene scene = makePickupScene({}, makePickupObject({}), {});
  double width = 0.056, stiffness = 300;
  double time = 0;
  Percept percept;

  Phantom() {
    scene.cues.seed = 11;
    for (std::size_t i = 0; i < 2; ++i) {
      percept.fingers[i].arm.valid = true;
      percept.fingers[i].arm.q_DF = scene.q_DF[i];
      percept.fingers[i].tactile = {0, true, Vec2(0, 0)};
    }
  }
  HandAction step(Participant& participant, Cue cue = Cue::kNone) {
    percept.time = time;
    percept.cue = cue;
    const HandAction action = participant.act(percept);
    std::array<Vec3, 2> p_WF;
    for (std::size_t i = 0; i < 2; ++i) p_WF[i] = scene.model.mounts[i].X_WD * action.pulls[i].p_D;
    const double pressed = std::max(0.0, 0.5 * (width - (p_WF[1] - p_WF[0]).norm()));
    for (std::size_t i = 0; i < 2; ++i) {
      percept.fingers[i].arm.p_DF = action.pulls[i].p_D;
      percept.fingers[i].f_D = Vec3(0, 0, -stiffness * pressed);
    }
    time += 1e-3;
    return action;
  }
  // Runs until the participant is in `phase`; false after `limit` [s].
  bool runTo(Participant& participant, HandPhase phase, double limit = 20) {
    for (const double end = time + limit; time < end;) {
      if (step(participant).intent.phase == phase) return true;
    }
    return false;
  }
};

bool sameBits(const HandAction& a, const HandAction& b) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (std::memcmp(a.pulls[i].p_D.data(), b.pulls[i].p_D.data(), 3 * sizeof(double)) != 0) return false;
  }
  return a.intent.phase == b.intent.phase;
}

TEST(ScriptedPickup, DoesTheSameForTheSameSeeds) {
  Phantom first, second;
  ScriptedPickup a(3), b(3);
  a.begin(first.scene.cues);
  b.begin(second.scene.cues);
  for (int i = 0; i < 8000; ++i) {
    const Cue cue = i == 10 ? Cue::kStart : Cue::kNone;
    ASSERT_TRUE(sameBits(first.step(a, cue), second.step(b, cue))) << "tick " << i;
  }
}

TEST(ScriptedPickup, VariesWithThePersonAndWithTheTrial) {
  Phantom phantom;
  const auto endOf = [&](std::uint64_t person, std::uint64_t trial) {
    ScriptedPickup participant(person);
    phantom.scene.cues.seed = trial;
    participant.begin(phantom.scene.cues);
    return phantom.step(participant);
  };
  EXPECT_NE(endOf(1, 1).pulls[0].stiffness, endOf(2, 1).pulls[0].stiffness);
  EXPECT_EQ(endOf(1, 1).pulls[0].stiffness, endOf(1, 2).pulls[0].stiffness);
  EXPECT_FALSE(sameBits(endOf(1, 1), endOf(1, 2)));
}

TEST(ScriptedPickup, WaitsForTheStartToneAndItsReactionTime) {
  Phantom phantom;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  EXPECT_FALSE(phantom.runTo(participant, HandPhase::kReach, 1.0));
  const double heard = phantom.time;
  phantom.step(participant, Cue::kStart);
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kReach));
  EXPECT_NEAR(phantom.time - heard, 0.25, 2.5e-3);  // two ticks and round-off
}

// Grip felt when the lift begins: the wanted one, 2 m g/(2 x 0.52), seen through a
// magnitude error of SD 10 % (five of them).
TEST(ScriptedPickup, SqueezesToTheWantedGripAndLifts) {
  Phantom phantom;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  phantom.step(participant, Cue::kStart);
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kSqueeze));
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kLift));
  const double wanted = 0.075 * 9.81 / 0.52;
  EXPECT_NEAR(-phantom.percept.fingers[0].f_D.z(), wanted, 0.5 * wanted);
  const double height = (phantom.scene.model.mounts[0].X_WD * phantom.percept.fingers[0].arm.p_DF).z();
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kHold));
  const double lifted = (phantom.scene.model.mounts[0].X_WD * phantom.percept.fingers[0].arm.p_DF).z() - height;
  // 50 mm asked for and 10 mm margin; the lift has moved for one tick when `height` is taken
  EXPECT_NEAR(lifted, 0.060, 1e-6);
}

TEST(ScriptedPickup, NoticesThatTheObjectGotAwayByTheLossOfForce) {
  Phantom phantom;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  phantom.step(participant, Cue::kStart);
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kLift));
  phantom.width = 0;
  const double lost = phantom.time;
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kReach, 1.0));
  EXPECT_GT(phantom.time - lost, 0.07);  // the reflex
  // and the decay of felt force from 2 N to 0.1 N: three time constants of 20 ms
  EXPECT_LT(phantom.time - lost, 0.07 + 0.1);
  phantom.width = 0.056;
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kLift));  // it tries again
}

// Half a second of lifting while the tactors run at 20 mm/s: grip of the hands' equilibria at its end [N].
double gripWhereTactorsRun(TactorUse use) {
  Phantom phantom;
  SensingLimits limits;
  limits.tactor_use = use;
  ScriptedPickup participant(1, {}, limits);
  participant.begin(phantom.scene.cues);
  phantom.step(participant, Cue::kStart);
  EXPECT_TRUE(phantom.runTo(participant, HandPhase::kLift));
  for (int i = 0; i < 500; ++i) {
    for (auto& finger : phantom.percept.fingers) finger.tactile.place_L->x() += 2e-5;
    phantom.step(participant);
  }
  return -phantom.percept.fingers[0].f_D.z();
}

// Seven stretches of the reflex time, each 1.3 times as hard: beyond the largest grip, which the
// hands reach at the stiffness of the phantom.
TEST(ScriptedPickup, GripsHarderWhereATactorRunsIfThatIsWhatTactorsAreFor) {
  const double place = gripWhereTactorsRun(TactorUse::kPlace), slip = gripWhereTactorsRun(TactorUse::kSlip);
  EXPECT_GT(slip, 1.3 * place);
  EXPECT_EQ(place, gripWhereTactorsRun(TactorUse::kNothing));
}

TEST(ScriptedPickup, OpensWhenItFindsNothingAndTriesElsewhere) {
  Phantom phantom;
  phantom.width = 0;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  phantom.step(participant, Cue::kStart);
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kClose));
  const Vec3 first_D = phantom.percept.fingers[0].arm.p_DF;
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kReach));
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kClose));
  EXPECT_GT((phantom.percept.fingers[0].arm.p_DF - first_D).norm(), 1e-4);
}

TEST(ScriptedPickup, GoesHomeAfterTheTone) {
  Phantom phantom;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  phantom.step(participant, Cue::kStart);
  ASSERT_TRUE(phantom.runTo(participant, HandPhase::kHold));
  EXPECT_EQ(phantom.step(participant, Cue::kSuccess).intent.phase, HandPhase::kReturn);
  EXPECT_TRUE(phantom.runTo(participant, HandPhase::kRest));
}

TEST(ScriptedPickup, AllocatesNothingWhileActing) {
  Phantom phantom;
  ScriptedPickup participant(1);
  participant.begin(phantom.scene.cues);
  const auto before = tests::allocationCount();
  for (int i = 0; i < 10000; ++i) phantom.step(participant, i == 5 ? Cue::kStart : Cue::kNone);
  EXPECT_EQ(tests::allocationCount() - before, 0);
}

}  // namespace
}  // namespace pincer::tasks
