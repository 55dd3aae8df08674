// Fingers on bodies of several shapes: they feel the body, not the parts that it is made of.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/polytope.h"
#include "pincer/contact/smooth_mesh.h"
#include "pincer/grasp/finger_distance.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

engine::ColliderSpec partOf(const contact::Shape& shape, const Vec3& p_BS) {
  return {"part", shape, Pose{Quat::Identity(), p_BS}};
}

// A box of 40 x 20 x 20 mm and 50 g, of one piece or of two halves.
engine::BodySpec halvedBox(bool is_halved, bool is_dynamic) {
  engine::BodySpec spec{"box", contact::Box{{0.02, 0.01, 0.01}}, is_dynamic, is_dynamic ? 0.05 : 0, {0.8, 0.8}};
  const contact::Box half{{0.01, 0.01, 0.01}};
  if (is_halved) spec.shapes = {partOf(half, {-0.01, 0, 0}), partOf(half, {0.01, 0, 0})};
  return spec;
}

// Two fingers at -y and +y, or as many as `tips`.
struct FingersAtBox {
  GraspModel model;
  GraspState state;
  ScratchHandle scratch;
  std::vector<FingerInput> inputs;

  FingersAtBox(const engine::BodySpec& body, const std::vector<Vec3>& at, bool pads = false) {
    engine::WorldBuilder builder{engine::WorldOptions{}};
    builder.addBody(body);
    std::vector<FingerModel> fingers(at.size(), tests::softFinger("finger"));
    for (FingerModel& f : fingers) {
      if (!pads) continue;
      std::vector<Vec3> corners;
      for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 7e-3 : -7e-3, i & 2 ? 2e-3 : -2e-3, i & 4 ? 7e-3 : -7e-3});
      f.shape = contact::PadTip{contact::Polytope::hullOf(corners, "pad"), 5e-4};
    }
    model = buildGrasp(builder, fingers);
    state = makeState(model, {tests::startAt(Vec3::Zero())}, at);
    scratch = makeScratch(model);
    inputs.resize(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) inputs[i].p_WF = at[i];
  }
  GraspReport tick() { return step(model, state, *scratch, inputs); }
};

// Pinched where the halves meet and carried to and fro: the same motion, the same force.
TEST(CompoundFingers, PinchTwoHalvesAtTheirSeamAsOneBox) {
  for (const bool pads : {false, true}) {
    const double reach = pads ? 0.0125 : 0.018;
    const std::vector<Vec3> at = {Vec3(0, -reach, 0), Vec3(0, reach, 0)};
    FingersAtBox one(halvedBox(false, true), at, pads), two(halvedBox(true, true), at, pads);
    double furthest = 0, force = 0;
    std::int64_t allocated = 0;
    for (int k = 0; k < 600; ++k) {
      for (FingersAtBox* grip : {&one, &two}) {
        for (std::size_t i = 0; i < 2; ++i)
          grip->inputs[i].p_WF = at[i] * (1 - 3e-3 / reach) + Vec3(5e-3 * std::sin(0.02 * k), 0, 1e-5 * k);
      }
      const double f = one.tick().fingers[0].f_contact_W.norm();
      if (k == 10) allocated = tests::allocationCount();
      force = std::max(force, std::abs(two.tick().fingers[0].f_contact_W.norm() - f));
      if (k == 10) {
        EXPECT_EQ(tests::allocationCount(), allocated);
      }
      furthest = std::max(furthest, (one.state.world.bodies[0].X_WI.p - two.state.world.bodies[0].X_WI.p).norm());
    }
    EXPECT_LT(furthest, 1e-9) << pads;  // the solver's 1e-10 of speeds of 0.1 m/s, over 0.6 s
    EXPECT_LT(force, 1e-6) << pads;     // of 3 N
  }
}

// Drawn over the seam of a box that stands. While it crosses, what it remembers of one half isn't known to the other: a
// few hundredths of 1 N are felt for some ticks; before and after there is no difference.
TEST(CompoundFingers, FeelLittleOfASeam) {
  FingersAtBox one(halvedBox(false, false), {Vec3(-0.015, 0, 0.018)}),
      two(halvedBox(true, false), {Vec3(-0.015, 0, 0.018)});
  double crossing = 0, elsewhere = 0;
  for (int k = 0; k < 500; ++k) {
    for (FingersAtBox* drawn : {&one, &two}) drawn->inputs[0].p_WF = Vec3(-0.015 + 6e-5 * k, 0, 0.017);
    const Vec3 f_one = one.tick().fingers[0].f_contact_W, f_two = two.tick().fingers[0].f_contact_W;
    double& worst = k > 200 && k < 350 ? crossing : elsewhere;
    worst = std::max(worst, (f_one - f_two).norm());
  }
  EXPECT_LT(crossing, 0.05);
  EXPECT_LT(elsewhere, 1e-6);
}

TEST(CompoundFingers, MeasureTheNearestShapeThatCanBeTouched) {
  engine::BodySpec cup{"cup", contact::Sphere{1}, false, 0, {}};
  cup.shapes = {partOf(contact::Sphere{0.01}, {0.05, 0, 0}), partOf(contact::Sphere{0.01}, {-0.03, 0, 0}),
                partOf(contact::Sphere{0.03}, Vec3::Zero())};
  cup.shapes[2].bits = {0, 0};  // only seen
  FingersAtBox look(cup, {Vec3(0.02, 0, 0)});
  const std::vector<FingerDistance> all = fingerDistances(look.model, look.state);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].gap, 0.012, 1e-15);  // to the first: 30 mm between the centres
  EXPECT_LT((all[0].p_body_W - Vec3(0.04, 0, 0)).norm(), 1e-15);
}

// Two smooth meshes of one body are followed apart, at poses of their own: forces are those of each mesh alone.
TEST(CompoundFingers, FollowEachMeshOfABody) {
  const auto surface = contact::SmoothMesh::build(contact::geodesicSphere(0.02, 6));
  const Pose X_left{quatFromRotationVector({0.3, -0.2, 1}), {-0.03, 0, 0}},
      X_right{quatFromRotationVector({1, 0.5, 0}), {0.03, 0, 0}};
  engine::BodySpec both{"both", contact::Sphere{1}, false, 0, {}};
  both.shapes = {{"left", contact::Mesh{surface}, X_left}, {"right", contact::Mesh{surface}, X_right}};
  const std::vector<Vec3> at = {Vec3(-0.03, 0, 0.028), Vec3(0.03, 0, 0.028)};
  FingersAtBox together(both, at);
  engine::BodySpec left = both, right = both;
  left.shapes.pop_back();
  right.shapes.erase(right.shapes.begin());
  FingersAtBox on_left(left, {at[0]}), on_right(right, {at[1]});
  for (int k = 0; k < 300; ++k) {
    const Vec3 way(1e-5 * k, 2e-5 * k, -1e-3);
    for (std::size_t i = 0; i < 2; ++i) together.inputs[i].p_WF = at[i] + way;
    on_left.inputs[0].p_WF = at[0] + way;
    on_right.inputs[0].p_WF = at[1] + way;
    const GraspReport report = together.tick();
    const Vec3 f_left = report.fingers[0].f_contact_W, f_right = report.fingers[1].f_contact_W;
    ASSERT_EQ(f_left, on_left.tick().fingers[0].f_contact_W) << k;
    ASSERT_EQ(f_right, on_right.tick().fingers[0].f_contact_W) << k;
  }
}

}  // namespace
}  // namespace pincer::grasp
