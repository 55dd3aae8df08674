// Trees at their limits of speed, joints that dry friction holds without a row, and the loads that joints carry.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/constants.h"

namespace pincer::engine::tree_force_tests {
namespace {

using tests::kGravity;
using tests::kPi;

const Quat kToX(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));   // turns z to x
const Quat kToY(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));  // turns z to y

// Bodies on joints, numbered as they were added.
class Machine {
 public:
  explicit Machine(double g) {
    options_.gravity_W = Vec3(0, 0, -g);
    builder_.emplace(options_);
  }
  int body(double mass, const Vec3& p_W, const contact::Shape& shape = contact::Sphere{0.01}) {
    starts_.push_back({{Quat::Identity(), p_W}, Vec3::Zero(), Vec3::Zero()});
    return builder_->addBody({"body" + std::to_string(starts_.size()), shape, true, mass, {}});
  }
  // A joint at p_W, z along `q`'s.
  int joint(JointKind kind, int a, int b, const Vec3& p_W, const Quat& q, const JointTraits& traits = {}) {
    const auto placed = [&](int i) {
      return Pose{q, i < 0 ? p_W : Vec3(p_W - starts_[static_cast<std::size_t>(i)].X_WB.p)};
    };
    JointModel joint{kind, a, b, placed(a), placed(b), 0};
    joint.name = "joint" + std::to_string(joints_++);
    joint.traits = traits;
    return builder_->addJoint(joint);
  }
  void exclude(int a, int b) { builder_->excludePair(a, b); }
  void motor(int joint) {
    DriveModel drive;
    drive.name = "motor" + std::to_string(joint);
    drive.terms = {{joint, 1}};
    builder_->addDrive(drive);
  }
  void build() {
    model = builder_->build();
    state = makeState(model, starts_, {});
    scratch = makeScratch(model);
    controls.resize(model.drives.size());
  }
  StepReport tick() { return step(model, state, *scratch, {{}, {}, {forces, {}}, controls}); }
  void run(int ticks) {
    for (int n = 0; n < ticks; ++n) status |= tick().status;
  }
  double energy() const { return kineticEnergy(model, state) + potentialEnergy(model, state); }
  JointLoad load(int joint) const { return jointLoadAt(model, state, *scratch, joint, {forces, {}}); }

  WorldModel model;
  WorldState state;
  ScratchHandle scratch;
  std::vector<DriveInput> controls;
  std::vector<BodyForce> forces;
  std::uint32_t status = 0;

 private:
  WorldOptions options_;
  std::optional<WorldBuilder> builder_;
  std::vector<BodyStart> starts_;
  int joints_ = 0;
};

// A chain of hinges about x, y, x, .. with links of very different mass.
Machine chain(int links, bool driven, bool touches) {
  Machine machine(0);
  JointTraits traits;
  traits.armature = 1e-9;
  for (int i = 0; i < links; ++i) {
    const double top = -0.05 * i;
    const int body = machine.body(i % 2 == 0 ? 1 : 1e-3, {0, 0, top - 0.025}, contact::Box{{0.004, 0.004, 0.02}});
    machine.joint(JointKind::kPivot, body, body - 1, {0, 0, top}, i % 2 == 0 ? kToX : kToY, traits);
    if (driven) machine.motor(i);
    for (int other = 0; other < body && !touches; ++other) machine.exclude(other, body);
  }
  machine.build();
  return machine;
}

// A tree that a tick can't follow was once flung ever faster by its own inertia, to what isn't a number.
TEST(TreeSpeed, AChainThatSpinsFasterThanATickCanFollowGainsNoEnergyAndIsFlagged) {
  for (const int links : {1, 3, 6}) {
    for (const double rate : {2e4, 1e7}) {
      Machine machine = chain(links, false, false);
      for (int j = 0; j < links; ++j) setJoint(machine.model, machine.state, j, 0.3, rate * (j % 2 == 0 ? 1 : -0.7));
      const double start = machine.energy();
      bool flagged = false;
      for (int n = 0; n < 8; ++n) {
        flagged = (machine.tick().status & kTurnsTooFar) != 0 || flagged;
        // Ticks that aren't limited keep energy to the 4th order of half a radian per part, 1e-3.
        ASSERT_LE(machine.energy(), start * (1 + 1e-2)) << links << ' ' << rate << ' ' << n;
      }
      EXPECT_TRUE(flagged || rate < 5e4) << links << ' ' << rate;
    }
  }
}

TEST(TreeSpeed, UndampedMotorsNeverMakeAStateThatIsNoNumber) {
  for (const double torque : {1e4, 1e6}) {
    Machine machine = chain(5, true, true);
    for (std::size_t d = 0; d < machine.controls.size(); ++d)
      machine.controls[d].value = d % 2 == 0 ? torque : -0.3 * torque;
    machine.run(12);
    EXPECT_EQ(machine.status & kStateNotFinite, 0U) << torque;
    EXPECT_NE(machine.status & kTurnsTooFar, 0U) << torque;
  }
}

// Two hinges about y that hang, bent by 90 degrees, held by dry friction.
struct BentArm : Machine {
  static constexpr double kFirst = 0.3, kSecond = 0.1, kLength = 0.1;
  explicit BentArm(double friction) : Machine(kGravity) {
    JointTraits traits;
    traits.friction = friction;
    body(kFirst, {0, 0, -kLength / 2});
    body(kSecond, {kLength / 2, 0, -kLength});
    joint(JointKind::kPivot, 0, -1, Vec3::Zero(), kToY, traits);
    joint(JointKind::kPivot, 1, 0, {0, 0, -kLength}, kToY, traits);
    motor(1);
    build();
  }
  static constexpr double torque() { return kSecond * kGravity * kLength / 2; }
};

TEST(LockedJoints, StandToTheBitWithoutARowAndTellWhatTheyHold) {
  BentArm arm(3 * BentArm::torque());
  arm.run(20);
  const WorldState before = arm.state;
  arm.run(200);
  EXPECT_EQ(arm.state.tree_q, before.tree_q);
  EXPECT_EQ(arm.scratch->joint_contacts, 0);
  EXPECT_EQ(arm.status, kStepOk);
  for (const int j : {0, 1})
    EXPECT_NEAR(std::abs(jointAt(arm.model, *arm.scratch, j).friction_force), BentArm::torque(), 1e-12);
}

TEST(LockedJoints, HoldUpToTheirFrictionAndSlipBeyond) {
  const double friction = 3 * BentArm::torque();
  for (const double ratio : {0.999, 1.001}) {
    BentArm arm(friction);
    arm.run(20);
    // The weight turns the second link by q > 0 about y; the motor adds to that.
    const double sign = jointAt(arm.model, *arm.scratch, 1).friction_force > 0 ? -1 : 1;
    for (int n = 0; n < 300; ++n) {
      arm.controls[0].value = sign * (ratio * friction - BentArm::torque()) * std::min(1.0, n / 100.0);
      arm.status |= arm.tick().status;
    }
    const double moved = std::abs(jointPosition(arm.model, arm.state, 1));
    EXPECT_EQ(arm.status, kStepOk);
    if (ratio < 1)
      EXPECT_LT(moved, 1e-12);
    else
      EXPECT_GT(moved, 1e-7);
  }
}

// Locked joints once would have kept what hits them from moving them.
TEST(LockedJoints, GiveWayToWhatFallsOnThem) {
  Machine machine(kGravity);
  JointTraits traits;
  traits.friction = 0.02;
  machine.body(0.01, {0.05, 0, 0}, contact::Box{{0.05, 0.01, 0.005}});
  machine.joint(JointKind::kPivot, 0, -1, Vec3::Zero(), kToY, traits);
  machine.body(0.2, {0.09, 0, 0.06}, contact::Sphere{0.01});
  machine.build();
  machine.run(80);
  EXPECT_NEAR(jointPosition(machine.model, machine.state, 0), 0, 1e-13);  // until its first tick's speed was stopped
  machine.run(120);
  EXPECT_GT(std::abs(jointPosition(machine.model, machine.state, 0)), 0.1);
  EXPECT_EQ(machine.status, kStepOk);
}

TEST(JointLoads, AreTheWeightOfWhatHangsOnThemAndTheForcesApplied) {
  BentArm arm(1);
  arm.forces.resize(2);
  arm.forces[1] = {Vec3(0.5, 0.25, 0), Vec3::Zero()};
  arm.run(50);
  const JointLoad load = arm.load(0);
  const double weight = (BentArm::kFirst + BentArm::kSecond) * kGravity;
  const Vec3 f_W = kToY * load.f_J, moment_W = kToY * load.moment_J;
  EXPECT_LT((f_W - Vec3(-0.5, -0.25, weight)).norm(), 1e-12);
  // About the first joint: the second link's weight and the push at (.05, 0, -.1).
  const Vec3 push = Vec3(0.05, 0, -0.1).cross(Vec3(0.5, 0.25, -BentArm::kSecond * kGravity));
  EXPECT_LT((moment_W + push).norm(), 1e-12);
}

// m w^2 r towards the axis, with a tree (armature) and as a lone held body; about the axis nothing.
TEST(JointLoads, OfASpinningArmAreItsCentripetalForce) {
  for (const double armature : {0.0, 1e-5}) {
    Machine machine(0);
    JointTraits traits;
    traits.armature = armature;
    machine.body(0.2, {0.1, 0, 0});
    machine.joint(JointKind::kPivot, 0, -1, Vec3::Zero(), Quat::Identity(), traits);
    machine.build();
    constexpr double kRate = 5;
    machine.state.bodies[0].v_W = Vec3(0, 0.1 * kRate, 0);
    machine.state.bodies[0].L_W = Vec3(0, 0, kRate / machine.model.bodies[0].rotation.inverse_moments.maxCoeff());
    if (armature > 0) setJoint(machine.model, machine.state, 0, 0, kRate);
    machine.run(10);
    const JointLoad load = machine.load(0);
    // Differences over a tick: (h w)^2/24 = 1e-6 of it.
    EXPECT_NEAR(load.f_J.norm(), 0.2 * kRate * kRate * 0.1, 1e-5) << armature;
    EXPECT_LT(load.moment_J.norm(), 1e-9) << armature;
  }
}

TEST(JointLoads, HoldWhatLiesOnALink) {
  Machine machine(kGravity);
  JointTraits traits;
  traits.friction = 5;
  machine.body(0.1, {0.1, 0, 0}, contact::Box{{0.1, 0.02, 0.01}});
  machine.joint(JointKind::kPivot, 0, -1, Vec3::Zero(), kToY, traits);
  machine.body(0.3, {0.15, 0, 0.02}, contact::Box{{0.01, 0.01, 0.01}});
  machine.build();
  machine.run(100);
  const JointLoad load = machine.load(0);
  EXPECT_NEAR((kToY * load.f_J).z(), 0.4 * kGravity, 1e-9);
  // the solver's tolerance, 1e-9 of it
  EXPECT_NEAR(std::abs(load.moment_J.z()), (0.1 * 0.1 + 0.3 * 0.15) * kGravity, 1e-8);
}

TEST(JointLoads, OfALoopAreNotANumber) {
  Machine machine(kGravity);
  machine.body(0.1, {0.05, 0, 0});
  machine.body(0.1, {0.15, 0, 0});
  machine.joint(JointKind::kBall, 0, -1, {0, 0, 0}, Quat::Identity());
  const int middle = machine.joint(JointKind::kBall, 1, 0, {0.1, 0, 0}, Quat::Identity());
  machine.joint(JointKind::kBall, 1, -1, {0.2, 0, 0}, Quat::Identity());
  machine.build();
  machine.run(2);
  EXPECT_TRUE(std::isnan(machine.load(middle).f_J.x()));
}

}  // namespace
}  // namespace pincer::engine::tree_force_tests
