// The page that computes: a person's actions there, against closed forms.
#include "pincer/tasks/play/play_session.h"

#include <gtest/gtest.h>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

constexpr int kBall = 1;
constexpr double kGravity = 9.81;

void run(PlaySession& session, const PlayWish& wish, double seconds) {
  for (int i = 0; i < static_cast<int>(seconds / PlaySession::kTick); ++i) session.tick(wish);
}

// At grip n and height z each finger carries m g/2: its spring of 400 N/m sags by 0.92 mm.
TEST(PlaySession, HandThatSqueezesLiftsTheBallWithItsGrip) {
  PlaySession session("pickup");
  run(session, {Vec3(0, 0, 0.02), false, 2}, 0.5);
  run(session, {Vec3(0, 0, 0.02), true, 2}, 1);
  run(session, {Vec3(0, 0, 0.06), true, 2}, 1);
  run(session, {Vec3(0.02, 0.01, 0.06), true, 2}, 2);
  const double sag = 0.075 * kGravity / 2 / 400;
  // 20 um: by 6 um it rolled in the grip while it was lifted out of the dish, and friction keeps that
  EXPECT_NEAR((session.bodyPose(kBall).p - Vec3(0.02, 0.01, 0.06 - sag)).norm(), 0, 2e-5);
  for (const auto& report : session.reports()) {
    EXPECT_NEAR(report.normal_force, 2, 0.05);  // the hand closes by steps of 0.1 mm: 0.04 N
    EXPECT_NEAR(report.tangential_force, 0.075 * kGravity / 2, 1e-3);
    EXPECT_FALSE(report.sliding);
  }
  EXPECT_EQ(session.flagged(), 0);
  run(session, {Vec3(0.02, 0.01, 0.06), false, 2}, 2);
  EXPECT_LT(session.bodyPose(kBall).p.z(), 0.0301) << "let go, it lies in the dish";
}

// Two contacts of mu 0.5 bear 2 mu n across; the weight of 0.981 N hangs on them already.
TEST(PlaySession, PulledBallStaysUntilFrictionCantHoldIt) {
  PlaySession session("pinch");
  const Vec3 start_W = session.bodyPose(kBall).p;
  run(session, {start_W + Vec3(0, 1.6 / 60, 0), true, 2}, 2);  // sqrt(1.6^2 + 0.981^2) = 1.88 of 2 N
  EXPECT_NEAR(session.pull_W().norm(), 1.6, 1e-9);
  EXPECT_LT((session.bodyPose(kBall).p - start_W).norm(), 1e-12);
  run(session, {start_W + Vec3(0, 1.8 / 60, 0), true, 2}, 0.1);  // 2.05 N
  EXPECT_GT((session.bodyPose(kBall).p - start_W).norm(), 1e-5);
}

TEST(PlaySession, AHandOutOfReachStaysOverTheDish) {
  PlaySession session("pickup");
  run(session, {Vec3(5, 0, -3), true, 50}, 2);
  EXPECT_LT(session.fingertip(0).cwiseAbs().maxCoeff(), 0.17);
  EXPECT_GT(session.fingertip(0).z(), 0);
}

TEST(PlaySession, ScriptedHandDoesTheSameTwice) {
  EXPECT_EQ(hashOfScript("pickup", 500), hashOfScript("pickup", 500));
  EXPECT_NE(hashOfScript("pickup", 500), hashOfScript("pickup", 501));
}

TEST(PlaySession, UnknownSceneIsNamed) { EXPECT_THROW(PlaySession("juggle"), InputError); }

}  // namespace
}  // namespace pincer::tasks
