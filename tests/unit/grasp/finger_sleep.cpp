// A held object sleeps, with what the fingers feel unchanged, and wakes when a finger or its force moves.
#include <gtest/gtest.h>

#include "tests/support/worlds.h"

namespace pincer::grasp {
namespace {

TEST(FingerSleep, HoldsAPinchAndWakesAtATouch) {
  tests::GraspWorld w = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3), other = tests::pinchedBall(0.05, 0.8, 1000, 3.3e-3);
  other.model.world.options.sleep = false;
  GraspScratch scratch(w.model), other_scratch(other.model);
  std::vector<FingerInput> inputs = tests::squeezing(2e-3);
  const auto tick = [&] {
    const bool asleep = step(w.model, w.state, scratch, inputs).asleep;
    step(other.model, other.state, other_scratch, inputs);
    EXPECT_EQ(engine::hashOf(w.state.world), engine::hashOf(other.state.world)) << w.state.world.tick;
    for (std::size_t f = 0; f < 2; ++f) EXPECT_EQ(scratch.fingers[f].f_contact_W, other_scratch.fingers[f].f_contact_W);
    return asleep;
  };
  bool asleep = false;
  for (int i = 0; i < 1500; ++i) asleep = tick();
  ASSERT_TRUE(asleep);
  inputs[0].q_WF = Quat(Eigen::AngleAxisd(1e-3, Vec3::UnitZ()));  // the pad turns, and the ball with it
  EXPECT_FALSE(tick());
  for (int i = 0; i < 1500; ++i) asleep = tick();
  EXPECT_TRUE(asleep);
  inputs[1].f_W.z() = 1e-6;
  EXPECT_FALSE(tick());
  inputs[1].f_W.z() = 0;
  inputs[0].p_WF.x() += 1e-9;
  EXPECT_FALSE(tick());
}

}  // namespace
}  // namespace pincer::grasp
