// How far fingers are from bodies, and where the two are nearest.
#include <gtest/gtest.h>

#include "pincer/grasp/finger_distance.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

TEST(FingerDistance, OfEveryFingerAndBody) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {}});
  FingerModel round = tests::softFinger("round"), egg = tests::softFinger("egg");
  egg.shape = contact::EllipsoidTip{Vec3(6e-3, 9e-3, 9e-3)};
  const GraspModel model = buildGrasp(builder, {round, egg});
  const Vec3 p_ball(0, 0, 0.1), p_round(-0.05, 0, 0.1), p_egg(0.04, 0, 0.1);
  const GraspState state = makeState(model, {tests::startAt(p_ball), tests::startAt(Vec3::Zero())}, {p_round, p_egg});
  const std::vector<FingerDistance> all = fingerDistances(model, state);
  ASSERT_EQ(all.size(), 4u);
  EXPECT_NEAR(all[0].gap, 0.05 - 0.028, 1e-15);
  EXPECT_LT((all[0].p_body_W - Vec3(-0.02, 0, 0.1)).norm(), 1e-15);
  EXPECT_LT((all[0].p_finger_W - Vec3(-0.042, 0, 0.1)).norm(), 1e-15);
  EXPECT_NEAR(all[1].gap, 0.1 - 0.008, 1e-15);
  EXPECT_NEAR(all[2].gap, 0.04 - 0.026, 1e-12);  // along its short axis
  EXPECT_LT((all[2].p_finger_W - Vec3(0.034, 0, 0.1)).norm(), 1e-9);
  EXPECT_NEAR(all[3].gap, 0.1 - 0.009, 1e-12);
  for (const FingerDistance& d : all) EXPECT_LT((d.p_finger_W - d.p_body_W - d.gap * d.n_W).norm(), 1e-12);
}

TEST(FingerDistance, LeavesTheStateAlone) {
  tests::GraspWorld w = tests::pinchedBall(0.075, 0.6);
  GraspScratch scratch(w.model);
  for (int i = 0; i < 50; ++i) step(w.model, w.state, scratch, tests::squeezing(1e-3));
  GraspState before = w.state;
  fingerDistances(w.model, w.state);
  for (int i = 0; i < 50; ++i) {
    step(w.model, w.state, scratch, tests::squeezing(1e-3));
    step(w.model, before, scratch, tests::squeezing(1e-3));
  }
  EXPECT_EQ(engine::hashOf(w.state.world), engine::hashOf(before.world));
}

}  // namespace
}  // namespace pincer::grasp
