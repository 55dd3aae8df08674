// Results of a tick, read with the public headers alone: fingers' reports and contacts.
#include <gtest/gtest.h>

#include "pincer/grasp/step.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

struct HeldBall {
  tests::GraspWorld w = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3);
  ScratchHandle scratch = makeScratch(w.model);
  std::vector<FingerInput> inputs = tests::squeezing(2e-3);

  GraspReport tick() { return step(w.model, w.state, *scratch, inputs); }
};

TEST(StepResults, ContactsAreWhatTheFingersFeel) {
  HeldBall ball;
  GraspReport report;
  for (int i = 0; i < 50; ++i) report = ball.tick();
  ball.inputs[0].q_WF = Quat(Eigen::AngleAxisd(0.01, Vec3::UnitX()));  // about the normal: torsion
  report = ball.tick();
  const engine::WorldScratch& world = worldOf(*ball.scratch);
  ASSERT_EQ(report.contacts, 2);
  ASSERT_EQ(engine::contactCount(world), 2);
  for (int k = 0; k < 2; ++k) {
    const engine::ContactReport contact = engine::contactAt(world, k);
    const FingerReport& finger = report.fingers[static_cast<std::size_t>(k)];
    EXPECT_EQ(contact.point, k);
    EXPECT_EQ(contact.other_body, -1);
    EXPECT_EQ(contact.body, 0);
    EXPECT_TRUE(contact.pushes);
    EXPECT_EQ(contact.mu, 0.8);
    EXPECT_LT((contact.f_W - finger.f_contact_W).norm(), 1e-12);
    EXPECT_LT((contact.p_W - finger.p_WC).norm(), 1e-12);
    EXPECT_GT(contact.n_W.dot(finger.n_W), 1 - 1e-12);
    EXPECT_GT(std::abs(finger.torsion), 1e-9);
    EXPECT_NEAR(contact.moment_W.dot(contact.n_W), finger.torsion, 1e-12);
  }
}

TEST(StepResults, ForcesCarryTheBall) {
  HeldBall ball;
  GraspReport report;
  for (int i = 0; i < 1500; ++i) report = ball.tick();
  Vec3 on_ball_W = Vec3::Zero();
  const engine::WorldScratch& world = worldOf(*ball.scratch);
  for (int k = 0; k < engine::contactCount(world); ++k) on_ball_W -= engine::contactAt(world, k).f_W;
  EXPECT_LT((on_ball_W - Vec3(0, 0, 0.05 * tests::kGravity)).norm(), 1e-9);
}

TEST(StepResults, OfATickThatRepeatsTheLastOneStay) {
  HeldBall ball;
  GraspReport report;
  for (int i = 0; i < 3000 && !report.asleep; ++i) report = ball.tick();
  ASSERT_TRUE(report.asleep);
  EXPECT_EQ(report.contacts, 2);
  EXPECT_EQ(engine::contactCount(worldOf(*ball.scratch)), 2);
  EXPECT_GT(report.fingers[0].normal_force, 1);
  EXPECT_EQ(report.fingers.data(), fingersOf(*ball.scratch).data());
}

TEST(StepResults, SayThatNoFingerTouchesBeforeTheFirstTick) {
  const HeldBall ball;
  ASSERT_EQ(fingersOf(*ball.scratch).size(), 2u);
  EXPECT_FALSE(fingersOf(*ball.scratch)[0].touching);
  EXPECT_EQ(engine::contactCount(worldOf(*ball.scratch)), 0);
}

// Boxes on a floor, of which those that sleep are told of behind the others.
TEST(StepResults, TellOfContactsThatSleep) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  builder.addBody({"box", contact::Box{Vec3::Constant(0.01)}, true, 0.1, {}});
  builder.addBody({"ball", contact::Sphere{0.01}, true, 0.1, {}});
  const engine::WorldModel model = builder.build();
  const std::vector<engine::BodyStart> starts = {tests::startAt(Vec3::Zero()), tests::startAt(Vec3(0, 0, 0.01)),
                                                 tests::startAt(Vec3(0.1, 0, 0.01), Vec3(0.1, 0, 0))};
  engine::WorldState state = engine::makeState(model, starts, {});
  const engine::ScratchHandle scratch = engine::makeScratch(model);
  for (int i = 0; i < 200; ++i) engine::step(model, state, *scratch);
  ASSERT_EQ(engine::contactCount(*scratch), 5);
  double weight = 0;
  for (int k = 1; k < 5; ++k) {
    const engine::ContactReport contact = engine::contactAt(*scratch, k);
    EXPECT_EQ(contact.other_body + contact.body, 1) << k;  // the box and the floor
    weight += std::abs(contact.f_W.z());
  }
  EXPECT_EQ(engine::contactAt(*scratch, 0).other_body + engine::contactAt(*scratch, 0).body, 2);  // the ball, awake
  EXPECT_NEAR(weight, 0.1 * tests::kGravity, 1e-9);
}

}  // namespace
}  // namespace pincer::grasp
