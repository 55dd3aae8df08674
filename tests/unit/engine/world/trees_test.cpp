// Trees of joints in a world: stops, dry friction, drives and their limits, jaws.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"

namespace pincer::engine::tree_tests {
namespace {

using tests::kGravity;
using tests::kPi;

const Quat kAlongX(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));  // turns z to x
constexpr double kMass = 0.1;                                   // of a slider [kg]

WorldOptions tickOf(double h, double g = kGravity) {
  WorldOptions options;
  options.h = h;
  options.gravity_W = Vec3(0, 0, -g);
  return options;
}

struct Driven {
  WorldModel model;
  WorldState state;
  WorldScratch scratch;
  std::vector<DriveInput> controls;
  std::uint32_t status = 0;
  int asleep = 0;

  Driven(const WorldBuilder& builder, const std::vector<BodyStart>& starts)
      : model(builder.build()), state(makeState(model, starts, {})), scratch(model), controls(model.drives.size()) {}
  void tick() {
    StepInputs inputs;
    inputs.controls = controls;
    const StepReport report = step(model, state, scratch, inputs);
    status |= report.status;
    asleep += report.asleep;
  }
  void run(double seconds) {
    for (int n = static_cast<int>(std::lround(seconds / model.options.h)); n > 0; --n) tick();
  }
  double q(int joint = 0) const { return jointPosition(model, state, joint); }
  double v(int joint = 0) const { return jointVelocity(model, state, joint); }
};

// A body on a vertical slider, 0.1 m above 0.
Driven slider(double h, const JointTraits& traits, double v = 0, double g = kGravity,
              const DriveModel* drive = nullptr) {
  WorldBuilder builder(tickOf(h, g));
  builder.addBody({"slide", contact::Box{Vec3::Constant(0.01)}, true, kMass, {}});
  JointModel joint{JointKind::kSlider, 0, -1, {}, {}, 0};
  joint.name = "rail";
  joint.traits = traits;
  const int number = builder.addJoint(joint);
  if (drive) {
    DriveModel own = *drive;
    own.name = "motor";
    own.terms = {{number, 1}};
    builder.addDrive(own);
  }
  return {builder, {{{Quat::Identity(), Vec3(0, 0, 0.1)}, Vec3(0, 0, v), Vec3::Zero()}}};
}

class TreeTicks : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Trees, TreeTicks, testing::Values(1e-4, 1e-3, 4e-3));

TEST_P(TreeTicks, ASliderLandsOnItsStopAndStaysToTheBit) {
  for (const double v : {0.0, -0.5, -5.0}) {
    JointTraits traits;
    traits.lower = 0;
    Driven world = slider(GetParam(), traits, v);
    world.run(1);
    EXPECT_NEAR(world.q(), 0, 1e-12) << v;
    EXPECT_EQ(world.v(), 0) << v;
    EXPECT_EQ(world.status, kStepOk) << v;
    EXPECT_GT(world.asleep, 0) << v;
    EXPECT_NEAR(jointAt(world.model, world.scratch, 0).stop_force, kMass * kGravity, 1e-9) << v;
  }
}

// Newton's law at the moment of the hit: the next apex is e^2 times as high. At 1e-3
// of it for the parabola between two ticks.
TEST_P(TreeTicks, ASliderBouncesToESquaredOfItsHeight) {
  JointTraits traits;
  traits.lower = 0;
  traits.restitution = 0.5;
  Driven world = slider(GetParam(), traits);
  world.run(std::ceil(std::sqrt(2 * 0.1 / kGravity) / GetParam()) * GetParam());
  const double energy = kGravity * world.q() + 0.5 * world.v() * world.v();
  EXPECT_NEAR(energy, 0.25 * kGravity * 0.1, 1e-12);
  world.run(2);
  EXPECT_EQ(world.v(), 0);
  EXPECT_NEAR(world.q(), 0, 1e-12);
}

TEST_P(TreeTicks, DryFrictionHoldsBelowItsLimitAndGivesWayAboveIt) {
  constexpr double kRounded = 2e-15;  // [m]; what is slower than 4 ulps per tick is at rest (linkNoise)
  for (const double share : {1.001, 2.0, 1e4}) {
    JointTraits traits;
    traits.friction = share * kMass * kGravity;
    Driven world = slider(GetParam(), traits);
    world.run(1);
    EXPECT_NEAR(world.q(), 0.1, kRounded) << share;
    EXPECT_NEAR(jointAt(world.model, world.scratch, 0).friction_force, kMass * kGravity, 1e-9) << share;
    EXPECT_EQ(world.status, kStepOk);
  }
  for (const double share : {0.999, 0.5}) {
    JointTraits traits;
    traits.friction = share * kMass * kGravity;
    Driven world = slider(GetParam(), traits);
    world.run(1);
    EXPECT_NEAR(world.v(), -(1 - share) * kGravity, 1e-9) << share;
    EXPECT_NEAR(jointAt(world.model, world.scratch, 0).friction_force, traits.friction, 1e-9) << share;
  }
}

// v^2 m / (2 f), off by no more than what half a tick at rest leaves.
TEST_P(TreeTicks, DryFrictionBringsToRestWhereItShould) {
  JointTraits traits;
  traits.friction = 0.3;
  Driven world = slider(GetParam(), traits, 0.5, 0);
  world.run(1);
  EXPECT_NEAR(world.q(), 0.1 + 0.25 * kMass / 0.6, traits.friction * GetParam() * GetParam() / (8 * kMass) + 1e-14);
  EXPECT_EQ(world.v(), 0);
}

TEST_P(TreeTicks, ADriveHoldsItsLoad) {
  for (const double stiffness : {100.0, 1e5}) {
    DriveModel drive;
    drive.control = DriveModel::Control::kPosition;
    drive.stiffness = stiffness;
    drive.damping = 2;
    Driven world = slider(GetParam(), {}, 0, kGravity, &drive);
    world.controls[0].value = 0.15;
    world.run(3);
    EXPECT_NEAR(stiffness * (0.15 - world.q()), kMass * kGravity, 1e-9) << stiffness;
    EXPECT_NEAR(driveAt(world.scratch, 0).force, kMass * kGravity, 1e-9) << stiffness;
  }
}

TEST_P(TreeTicks, ADriveAtItsLimitGivesThatAndNoMore) {
  DriveModel drive;
  drive.control = DriveModel::Control::kPosition;
  drive.stiffness = 1e4;
  drive.damping = 10;
  drive.upper_force = 0.9;
  drive.lower_force = -0.9;
  Driven world = slider(GetParam(), {}, 0, kGravity, &drive);
  world.controls[0].value = 0.15;
  world.run(0.5);
  EXPECT_TRUE(driveAt(world.scratch, 0).saturated);
  EXPECT_NEAR(driveAt(world.scratch, 0).force, 0.9, 1e-9);
  EXPECT_NEAR(world.v(), (0.9 / kMass - kGravity) * 0.5, 1e-9);
}

// Two sliders of 50 g with motors hold a cube between them.
Driven jaws(double h, double force, double mu) {
  Material material;
  material.mu_s = material.mu_d = mu;
  WorldBuilder builder(tickOf(h));
  for (const char* name : {"left", "right"})
    builder.addBody({name, contact::Box{Vec3(0.01, 0.01, 0.02)}, true, 0.05, material});
  builder.addBody({"cube", contact::Box{Vec3::Constant(0.02)}, true, kMass, material});
  for (int k = 0; k < 2; ++k) {
    JointModel joint{JointKind::kSlider, k, -1, {kAlongX, Vec3::Zero()}, {kAlongX, Vec3(0, 0, 0.1)}, 0};
    joint.traits.lower = -0.1;
    joint.traits.upper = 0.1;
    DriveModel motor;
    motor.name = "motor";
    motor.terms = {{builder.addJoint(joint), k == 0 ? 1.0 : -1.0}};
    builder.addDrive(motor);
  }
  const auto at = [](double x) { return BodyStart{{Quat::Identity(), Vec3(x, 0, 0.1)}, Vec3::Zero(), Vec3::Zero()}; };
  Driven world{builder, {at(-0.03), at(0.03), at(0)}};
  world.controls = {{force, 0, false}, {force, 0, false}};
  return world;
}

TEST_P(TreeTicks, JawsHoldACubeWithoutCreep) {
  Driven world = jaws(GetParam(), 1.002 * kMass * kGravity / (2 * 0.5), 0.5);
  world.run(0.5);
  const Vec3 before = world.state.bodies[2].X_WI.p;
  world.run(2);
  EXPECT_EQ(world.state.bodies[2].X_WI.p, before);
  EXPECT_EQ(world.status, kStepOk);
  EXPECT_GT(world.asleep, 0);
}

TEST_P(TreeTicks, JawsLoseACubeBelowTheLimit) {
  Driven world = jaws(GetParam(), 0.998 * kMass * kGravity / (2 * 0.5), 0.5);
  world.run(0.5);
  EXPECT_LT(world.state.bodies[2].v_W.z(), -0.5 * 0.002 * kGravity * 0.5);
}

TEST(WorldTrees, AllocateNothingInATick) {
  Driven world = jaws(1e-3, 2, 0.5);
  world.tick();
  const std::int64_t before = tests::allocationCount();
  world.run(0.1);
  EXPECT_EQ(tests::allocationCount(), before);
}

TEST(WorldTrees, TwoChainsOfSevenHingesHoldTogetherByContact) {
  WorldBuilder builder(tickOf(1e-3));
  std::vector<BodyStart> starts;
  for (int k = 0; k < 7; ++k) {
    builder.addBody({"link", contact::Box{Vec3(0.01, 0.02, 0.04)}, true, 0.1, {}});
    JointModel joint{JointKind::kPivot,
                     k,
                     k - 1,
                     {kAlongX, Vec3(0, 0, 0.05)},
                     {kAlongX, k == 0 ? Vec3(0, 0, 1) : Vec3(0, 0, -0.05)},
                     0.01};
    joint.traits.friction = 1e-3;
    builder.addJoint(joint);
    starts.push_back({{Quat::Identity(), Vec3(0, 0, 0.95 - 0.1 * k)}, Vec3::Zero(), Vec3::Zero()});
  }
  builder.addBody({"ball", contact::Sphere{0.03}, true, 0.2, {}});
  starts.push_back({{Quat::Identity(), Vec3(0, 0.051, 0.35)}, Vec3(0, -1, 0), Vec3::Zero()});
  Driven world{builder, starts};
  world.run(0.5);
  EXPECT_EQ(world.status, kStepOk);
  EXPECT_TRUE(std::isfinite(world.q(6)));
  EXPECT_LT(world.q(0), -1e-3);  // pushed by the ball
}

// An arm of seven hinges, two blocks of columns, falls onto the floor: both blocks stop it there.
TEST(Trees, AnArmOfTwoBlocksFallsOntoTheFloorAndIsHeldByIt) {
  WorldBuilder builder(tickOf(1e-3));
  Material material;
  material.mu_s = material.mu_d = 0.5;
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
  std::vector<BodyStart> starts = {{}};
  for (int k = 0; k < 7; ++k) {
    const int link = builder.addBody({"link", contact::Capsule{0.02, 0.04}, true, 0.3, material});
    const Quat lying(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));  // its own z along x
    const Quat along_y(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));
    starts.push_back({{lying, Vec3(0.05 + 0.1 * k, 0, 0.1)}, Vec3::Zero(), Vec3::Zero()});
    const Quat q_LJ = lying.conjugate() * along_y;
    const Pose before = k == 0 ? Pose{along_y, Vec3(0, 0, 0.1)} : Pose{q_LJ, Vec3(0, 0, 0.05)};
    const JointModel joint{JointKind::kPivot, link, k == 0 ? -1 : link - 1, {q_LJ, Vec3(0, 0, -0.05)}, before, 0.01};
    builder.addJoint(joint);
  }
  Driven world(builder, starts);
  const double start = kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state);
  double last = start;
  for (int n = 0; n < 1000; ++n) {
    world.tick();
    const double energy = kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state);
    EXPECT_LE(energy, last + 1e-4 * std::abs(start)) << n;  // second order in the tick
    last = energy;
  }
  for (const Contact& c : world.scratch.contacts) EXPECT_GT(c.phi, -1e-6);
  EXPECT_EQ(world.status, kStepOk);
}

// A trunk on a ball joint, and a leg of two bars that swings along its side, which it touches all
// the way: nothing moves it along the normal.
Driven legAlongATrunk(const Quat& turn) {
  WorldBuilder builder(tickOf(1e-3));
  const Quat along_y(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));  // turns z to y
  builder.addBody({"trunk", contact::Box{Vec3(0.2, 0.1, 0.2)}, true, 2, {0.5, 0.5}});
  builder.addJoint({JointKind::kBall, 0, -1, {Quat::Identity(), Vec3(0, 0, 0.2)}, {turn, turn * Vec3(0, 0, 0.2)}});
  std::vector<BodyStart> starts = {{{turn, Vec3::Zero()}, Vec3::Zero(), turn * Vec3(3, 2, 1)}};
  JointModel joint{JointKind::kPivot, 1, 0, {along_y, Vec3(0, 0, 0.1)}, {along_y, Vec3(0, 0.12, 0)}, 0};
  joint.traits.armature = 1e-5;
  for (const int k : {1, 2}) {
    joint.a = builder.addBody({k == 1 ? "upper" : "lower", contact::Capsule{0.02, 0.08}, true, 0.3, {0.5, 0.5}});
    starts.push_back({{turn, turn * Vec3(0, 0.12, 0.1 - 0.2 * k)}, Vec3::Zero(), Vec3::Zero()});
    if (k == 2) joint.b = 1, joint.X_BJ = {along_y, Vec3(0, 0, -0.1)};
    builder.addJoint(joint);
  }
  return {builder, starts};
}

TEST(Trees, ALinkThatGrazesItsTrunkOnAllItsWayIsNotPressedOff) {
  const Quat turns[] = {Quat::Identity(), Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, -1).normalized())),
                        Quat(Eigen::AngleAxisd(2.1, Vec3(-1, 1, 3).normalized()))};
  for (const Quat& turn : turns) {
    Driven world = legAlongATrunk(turn);
    const double start = kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state);
    world.run(2);
    EXPECT_EQ(world.status, kStepOk);
    EXPECT_LE(kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state),
              start + 1e-3 * std::abs(start));
  }
}

}  // namespace
}  // namespace pincer::engine::tree_tests
