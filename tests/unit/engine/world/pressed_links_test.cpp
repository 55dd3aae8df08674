// Links that drives press against something: contacts see them at rest where they are at rest.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/tests/support/constants.h"

namespace pincer::engine::pressed_link_tests {
namespace {

using tests::kGravity;
using tests::kPi;

const Quat kToY(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));  // turns z to y
constexpr double kTip = 0.01, kTipMass = 0.02, kStiffness = 1, kTarget = 1.5;

WorldOptions tickOf(double h) {
  WorldOptions options;
  options.gravity_W = Vec3(0, 0, -kGravity);
  options.h = h;
  return options;
}

Material roughness(double mu) {
  Material material;
  material.mu_s = material.mu_d = mu;
  return material;
}

BodyStart at(const Vec3& p_W) { return {{Quat::Identity(), p_W}, Vec3::Zero(), Vec3::Zero()}; }

struct World {
  World(const WorldBuilder& builder, const std::vector<BodyStart>& starts)
      : model(builder.build()), state(makeState(model, starts, {})), scratch(makeScratch(model)) {
    controls.assign(model.drives.size(), {kTarget, 0, false});
  }
  void run(double seconds) {
    const int ticks = static_cast<int>(std::lround(seconds / model.options.h));
    for (int n = 0; n < ticks; ++n) {
      const StepReport report = step(model, state, *scratch, {{}, {}, {}, controls});
      status |= report.status;
      asleep = report.asleep;
      contacts = report.contacts;
    }
  }

  WorldModel model;
  WorldState state;
  ScratchHandle scratch;
  std::vector<DriveInput> controls;
  std::uint32_t status = 0;
  bool asleep = false;
  int contacts = 0;
};

// A finger of hinges about y at `joints`, the base first; each carries the ball at the next one's place, the last one
// the tip's.
void addFinger(const std::vector<Vec3>& joints, const Vec3& tip_W, WorldBuilder& builder,
               std::vector<BodyStart>& starts) {
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const bool is_last = k + 1 == joints.size();
    starts.push_back(at(is_last ? tip_W : joints[k + 1]));
    const Vec3& p_W = starts.back().X_WB.p;
    const std::string name = std::to_string(starts.size());
    const int body = builder.addBody({"link" + name, contact::Sphere{kTip}, true, kTipMass, roughness(0.8)});
    const int base = k == 0 ? -1 : body - 1;
    const Vec3 on_base = k == 0 ? joints[k] : Vec3(joints[k] - starts[starts.size() - 2].X_WB.p);
    JointModel hinge{JointKind::kPivot, body, base, {kToY, joints[k] - p_W}, {kToY, on_base}, 0};
    hinge.name = "hinge" + name;
    DriveModel drive;
    drive.name = "drive" + name;
    drive.terms = {{builder.addJoint(hinge), 1}};
    drive.control = DriveModel::Control::kPosition;
    drive.stiffness = kStiffness;
    drive.damping = 0.1;
    builder.addDrive(drive);
  }
}

class PressedLinks : public ::testing::TestWithParam<double> {};

// The drive alone would turn the link by several rad/s within a tick. Contacts once saw it turn so: it stood 20 um in
// the floor, where they pushed as hard as that turn closed.
TEST_P(PressedLinks, TouchTheFloorAndAreNotInIt) {
  WorldBuilder builder(tickOf(GetParam()));
  std::vector<BodyStart> starts{at({0, 0, -0.02})};
  builder.addBody({"floor", contact::Box{Vec3(0.2, 0.2, 0.02)}, false, 1, roughness(0)});
  addFinger({{0, 0, 0.05}}, {0.05, 0, 0.02}, builder, starts);
  World world(builder, starts);
  world.run(1);
  const Vec3 tip_W = world.state.bodies[1].X_WI.p;
  EXPECT_NEAR(tip_W.z(), kTip, 1e-9);
  double pushed = 0;
  for (int k = 0; k < world.contacts; ++k) pushed += std::abs(contactAt(*world.scratch, k).f_W.z());
  EXPECT_NEAR(pushed, driveAt(*world.scratch, 0).force / tip_W.x() + kTipMass * kGravity, 1e-8);
  EXPECT_TRUE(world.asleep);
  EXPECT_EQ(world.status, kStepOk);
}

// Friction was spent on slip that wasn't there: what hinged fingers pressed against a wall crept by 41 um/s.
TEST_P(PressedLinks, HoldABoxAgainstAWallWithoutCreep) {
  WorldBuilder builder(tickOf(GetParam()));
  std::vector<BodyStart> starts{at({-0.02, 0, 0}), at({0.02, 0, 0.02})};
  builder.addBody({"wall", contact::Box{Vec3(0.02, 0.2, 0.2)}, false, 1, roughness(0.8)});
  builder.addBody({"box", contact::Box{Vec3(0.02, 0.02, 0.03)}, true, 0.1, roughness(0.8)});
  for (const double y : {-0.01, 0.012})
    addFinger({{0.06, y, -0.08}, {0.09, y, -0.03}}, {0.055, y, 0.03}, builder, starts);
  World world(builder, starts);
  for (DriveInput& control : world.controls) control.value = -kTarget;
  world.run(7);  // drives relax by a tenth of a second
  const Vec3 before = world.state.bodies[1].X_WI.p;
  world.run(2);
  EXPECT_EQ(world.state.bodies[1].X_WI.p, before);
  EXPECT_GT(before.z(), 0);
  EXPECT_TRUE(world.asleep);
}

// A slider was left in two pegs for good, though friction doesn't jam it: Newton's method failed on a W of rank one.
TEST_P(PressedLinks, OfOneFreedomAreMovedOutOfWhatTheyOverlap) {
  constexpr double kApart = 2 * kTip - 1e-4, kFriction = 0.4;
  for (const double tilt : {0.05, 0.15, 0.25, 0.35}) {  // of what pushes from the way that is free, < atan(0.4)
    WorldOptions options = tickOf(GetParam());
    options.gravity_W.setZero();
    WorldBuilder builder(options);
    std::vector<BodyStart> starts{at(Vec3::Zero())};
    BodySpec carriage{"carriage", {}, true, 0.2, roughness(kFriction)};
    for (const double x : {-0.05, 0.05})
      carriage.shapes.push_back(
          {.name = std::to_string(x), .shape = contact::Sphere{kTip}, .X_BS = {Quat::Identity(), {x, 0, 0}}});
    builder.addJoint({JointKind::kSlider, builder.addBody(carriage), -1, Pose{}, Pose{}, 0});
    for (const double x : {-0.05, 0.05}) {
      starts.push_back(at({x, kApart * std::sin(tilt), -kApart * std::cos(tilt)}));
      builder.addBody({std::to_string(x), contact::Sphere{kTip}, false, 1, roughness(kFriction)});
    }
    World world(builder, starts);
    world.run(0.5);
    for (const int peg : {1, 2}) {
      const Vec3& peg_W = world.state.bodies[static_cast<std::size_t>(peg)].X_WI.p;
      const Vec3 ball_W = world.state.bodies[0].X_WI.p + Vec3(peg_W.x(), 0, 0);
      EXPECT_GT((ball_W - peg_W).norm() - 2 * kTip, -2e-6) << tilt;
    }
    EXPECT_EQ(world.status, kStepOk);
  }
}

INSTANTIATE_TEST_SUITE_P(Ticks, PressedLinks, ::testing::Values(5e-4, 1e-3, 2e-3));

}  // namespace
}  // namespace pincer::engine::pressed_link_tests
