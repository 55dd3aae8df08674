// Two to ten fingers on one ball: what every grasp must keep, whatever their number.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

class FingerCount : public testing::TestWithParam<int> {};

TEST_P(FingerCount, HoldsWithinTheConeAndConservesMomentum) {
  const int n = GetParam();
  const double mass = 0.075, mu = 0.5;
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"ball", contact::Sphere{0.02}, true, mass, {mu, mu, 0, 3.3e-3}});
  std::vector<FingerModel> fingers;
  std::vector<Vec3> around, at;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * tests::kPi * i / n;
    fingers.push_back(tests::softFinger("finger"));
    around.push_back(Vec3(std::cos(a), std::sin(a), 0));
    at.push_back(Vec3(0, 0, 0.1) + 0.028 * around.back());
  }
  const GraspModel model = buildGrasp(builder, fingers);
  GraspState state = makeState(model, {tests::startAt(Vec3(0, 0, 0.1))}, at);
  GraspScratch scratch(model);
  std::vector<FingerInput> inputs(fingers.size());
  const double squeeze = 4e-3 / n;
  Vec3 settled = Vec3::Zero();
  for (int k = 0; k < 600; ++k) {
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].p_WF = Vec3(0, 0, 0.1) + (0.028 - squeeze) * around[i];
    const Vec3 before = state.world.bodies[0].v_W;
    step(model, state, scratch, inputs);
    Vec3 on_fingers = Vec3::Zero();
    for (const FingerReport& f : scratch.fingers) on_fingers += f.f_contact_W;
    const Vec3 change = mass * (state.world.bodies[0].v_W - before) / 1e-3 - mass * model.world.options.gravity_W;
    EXPECT_LT((change + on_fingers).norm(), 1e-10);  // forces of a few N, a rounding per finger, over h
    for (const engine::Contact& c : scratch.world.contacts) {
      EXPECT_LE(std::hypot(c.r.head<2>().norm(), c.r[engine::kTorsionRow]), c.mu * c.r[2] * (1 + 1e-12));
    }
    if (k == 300) settled = state.world.bodies[0].X_WI.p;
  }
  EXPECT_LT((state.world.bodies[0].X_WI.p - settled).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(TwoToTen, FingerCount, testing::Values(2, 3, 4, 5, 6, 7, 8, 9, 10));

}  // namespace
}  // namespace pincer::grasp
