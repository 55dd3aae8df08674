// Resistance to rolling under a finger.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

// A finger that strokes a held-up ball sideways turns it freely; with rolling resistance and no slip the
// ball's moment is felt as a tangential force.
TEST(FingerRolling, IsFeltAsATangentialForce) {
  const auto tangentialForce = [](double rolling_radius) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    const engine::Material material{0.9, 0.9, 0, 0, rolling_radius};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
    builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, material});
    tests::GraspWorld w{buildGrasp(builder, {tests::softFinger("top")}), {}};
    w.state = makeState(w.model, {tests::startAt(Vec3::Zero()), tests::startAt({0, 0, 0.02})}, {Vec3(0, 0, 0.048)});
    GraspScratch scratch(w.model);
    std::vector<FingerInput> inputs(1);
    for (int i = 0; i < 350; ++i) {
      // presses with 2 N, then moves at 1 mm/s
      inputs[0].p_WF = Vec3(i < 200 ? 0 : 1e-6 * (i - 200), 0, 0.048 - std::min(i, 100) * 2e-5);
      inputs[0].v_WF = Vec3(i < 200 ? 0 : 1e-3, 0, 0);
      step(w.model, w.state, scratch, inputs);
    }
    return std::abs(scratch.fingers[0].f_contact_W.x());
  };
  // it rolls between floor and finger; that is 75 um off its top by now: 2 N of 75 um / 28 mm
  EXPECT_LT(tangentialForce(0), 0.01);
  // Both contacts resist with up to mu e_r f_n, on arms of 2 R: f = mu e_r (2 N + 3 N) /
  // (2 R), less what slip takes of the cone.
  EXPECT_NEAR(tangentialForce(1e-3), 0.9 * 1e-3 * (2 + 2.981) / 0.04, 0.01);
}

}  // namespace
}  // namespace pincer::grasp
