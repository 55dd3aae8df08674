// Pads that turn past their devices against a spring.
#include <gtest/gtest.h>

#include "pincer/contact/polytope.h"
#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

contact::PadTip upright() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 1.5e-3 : -1.5e-3, i & 2 ? 9.5e-3 : -9.5e-3, i & 4 ? 9.5e-3 : -9.5e-3});
  return {contact::Polytope::hullOf(corners, "pad"), 5e-4};
}

// A pad at rest over a floor of mu = 1 whose device presses it 0.2 N deep and leads it `beside`
// along y, so that friction turns it about x.
struct PadOnFloor {
  GraspModel model;
  GraspState state;
  ScratchHandle scratch;
  FingerInput input;

  explicit PadOnFloor(double turn_stiffness) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, {1, 1, 0, 0}});
    FingerModel finger = tests::softFinger("pad", 1000, 5);
    finger.shape = upright();
    finger.coupling.turn_stiffness = turn_stiffness;
    finger.coupling.turn_damping = 1e-3 * turn_stiffness;
    model = buildGrasp(builder, {finger});
    input.p_WF = Vec3(0, 0, 0.01 - 2e-3);
    state = makeState(model, {engine::BodyStart{}}, {Vec3(0, 0, 0.01)});
    scratch = makeScratch(model);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) step(model, state, *scratch, {&input, 1});
  }
  Vec3 turn() const { return state.world.points[0].turn_W; }
};

// Pressed at its two lower edges by 2 N and dragged by 0.4 N along x, at 10 mm under its centre:
// k theta = moment of the contacts' forces.
TEST(TurningPad, CarriesItsContactsMomentByItsSpring) {
  PadOnFloor pad(0.5);
  pad.run(500);
  pad.input.p_WF += Vec3(4e-4, 0, 0);
  pad.run(2000);
  Vec3 moment = Vec3::Zero();
  const engine::WorldScratch& world = worldOf(*pad.scratch);
  for (int i = 0; i < engine::contactCount(world); ++i) {
    const engine::ContactReport c = engine::contactAt(world, i);
    if (c.pushes) moment += (c.p_W - pad.state.world.points[0].p_W).cross(c.f_W);
  }
  EXPECT_GT(pad.turn().norm(), 1e-4);
  EXPECT_LT((0.5 * pad.turn() - moment).norm(), 1e-9);
}

TEST(TurningPad, IsAsToldWhereItsSpringIsStiff) {
  PadOnFloor stiff(1e5), rigid(0);
  for (PadOnFloor* pad : {&stiff, &rigid}) {
    pad->run(500);
    pad->input.p_WF += Vec3(4e-4, 0, 0);
    pad->run(1000);
  }
  EXPECT_LT((stiff.state.world.points[0].p_W - rigid.state.world.points[0].p_W).norm(), 1e-7);
  EXPECT_LT(stiff.turn().norm(), 1e-6);
  EXPECT_TRUE(rigid.turn().isZero(0));
}

TEST(TurningPad, TurnsBackWhereNothingTouches) {
  PadOnFloor pad(0.5);
  pad.run(500);
  pad.input.p_WF += Vec3(4e-4, 0, 0);
  pad.run(500);
  pad.input.p_WF.z() = 0.05;
  pad.run(500);
  EXPECT_LT(pad.turn().norm(), 1e-12);
}

// The device turns under way: the turn past it goes along.
TEST(TurningPad, IsCarriedByItsDevice) {
  PadOnFloor pad(0.5);
  pad.run(500);
  pad.input.p_WF += Vec3(4e-4, 0, 0);
  pad.run(1000);
  const Vec3 before = pad.turn();
  for (int i = 1; i <= 100; ++i) {
    pad.input.q_WF = quatFromRotationVector(Vec3(0, 0, 1e-6 * i));
    pad.run(1);
  }
  pad.run(500);
  EXPECT_LT((pad.turn() - before).norm(), 0.05 * before.norm() + 1e-3);
  EXPECT_TRUE(pad.turn().allFinite());
}

TEST(TurningPad, DoesNotTwistBesides) {
  FingerModel finger = tests::softFinger("pad");
  finger.coupling.turn_stiffness = 1;
  finger.coupling.twist_stiffness = 1;
  const std::string error = tests::errorOf([&] { buildGrasp(engine::WorldBuilder{engine::WorldOptions{}}, {finger}); });
  EXPECT_NE(error.find("turn_stiffness"), std::string::npos) << error;
}

TEST(TurningPad, StoresItsSpringsEnergy) {
  PadOnFloor pad(0.5);
  pad.run(500);
  const double before = storedByFinger(pad.model, pad.state, 0);
  pad.state.world.points[0].turn_W = Vec3(0.1, 0, 0);
  EXPECT_NEAR(storedByFinger(pad.model, pad.state, 0) - before, 0.5 * 0.5 * 0.01, 1e-6);
}

}  // namespace
}  // namespace pincer::grasp
