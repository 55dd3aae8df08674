// Links that slide along what stands still: the contact turns with them, takes no energy, and the tick's order stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine::sliding_links_tests {
namespace {

constexpr double kLink = 0.2, kTip = 0.01, kBend = 0.9;  // lengths and radius [m]; of each link from the x axis [rad]
constexpr double kPull = 20;                             // towards the wall [m/s^2]

// Two links in the plane z = 0, the first on the world; the second's round tip on a wall before them, without friction.
struct Arm {
  WorldModel model;
  WorldState state;
  WorldScratch scratch;
  std::uint32_t status = 0;

  Arm(double h, double rate) : model(builderAt(h).build()), state(makeState(model, starts(), {})), scratch(model) {
    setJoint(model, state, 0, 0, rate);  // the second goes along: the tip stays on the wall
  }

  static Pose linkPose(int i) {
    const Vec3 along(0.5 * kLink * std::cos(kBend), 0.5 * kLink * std::sin(kBend), 0);
    const double side = i == 0 ? 1 : -1;
    const Quat q(Eigen::AngleAxisd(side * kBend, Vec3::UnitZ()));
    return {q, i == 0 ? along : Vec3(3 * along.x(), along.y(), 0)};
  }
  static std::vector<BodyStart> starts() {
    const Pose wall{Quat(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitY())), {2 * kLink * std::cos(kBend) + kTip, 0, 0}};
    return {{linkPose(0)}, {linkPose(1)}, {wall}};
  }
  static WorldBuilder builderAt(double h) {
    WorldOptions options;
    options.h = h;
    options.gravity_W = Vec3(kPull, 0, 0);
    WorldBuilder builder(options);
    const Material smooth{.mu_s = 0, .mu_d = 0};
    const Vec3 half(0.5 * kLink, 0, 0);
    for (int i = 0; i < 2; ++i) {
      BodySpec link{"link" + std::to_string(i), {}, true, 0.1, {}};
      link.shapes = {
          {.name = "tip", .shape = contact::Sphere{kTip}, .X_BS = {Quat::Identity(), half}, .material = smooth}};
      link.inertia = GivenInertia{Vec3::Zero(), Vec3(1e-5, 4e-4, 4e-4).asDiagonal()};
      builder.addBody(link);
    }
    builder.addBody({"wall", contact::HalfSpace{}, false, 0, smooth});
    builder.excludePair(0, 2);
    builder.addJoint(
        {JointKind::kPivot, 0, -1, Pose{Quat::Identity(), -half}, linkPose(0) * Pose{Quat::Identity(), -half}});
    const Quat bent(Eigen::AngleAxisd(-2 * kBend, Vec3::UnitZ()));
    builder.addJoint({JointKind::kPivot, 1, 0, Pose{Quat::Identity(), -half}, Pose{bent, half}});
    return builder;
  }
  void tick() { status |= step(model, state, scratch, StepInputs{}).status; }
  double energy() const { return kineticEnergy(model, state) + potentialEnergy(model, state); }
  bool touches() const { return contactCount(scratch) == 1 && contactAt(scratch, 0).pushes; }
};

// The most by which energy goes astray in 0.1 s, over that of the motion at the start.
double driftOf(double h, double rate) {
  Arm arm(h, rate);
  const double whole = kineticEnergy(arm.model, arm.state), start = arm.energy();
  double worst = 0;
  for (int n = 0; n < static_cast<int>(std::lround(0.1 / h)); ++n) {
    arm.tick();
    EXPECT_TRUE(arm.touches()) << n;
    worst = std::max(worst, std::abs(arm.energy() - start));
  }
  EXPECT_EQ(arm.status, kStepOk);
  return worst / whole;
}

TEST(SlidingLinks, KeepTheirEnergyToSecondOrderInTheTick) {
  for (const double rate : {-8.0, -4.0, 2.0, 5.0, 8.0}) {
    const double coarse = driftOf(1e-3, rate), fine = driftOf(5e-4, rate);
    EXPECT_LT(coarse, 2e-3) << rate;
    EXPECT_GT(coarse / fine, 3.8) << rate;
  }
}

}  // namespace
}  // namespace pincer::engine::sliding_links_tests
