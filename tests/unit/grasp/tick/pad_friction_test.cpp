// Flat pads: how their contacts share friction, and that it comes to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/contact/polytope.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kMu = 0.6;

// A body of 100 g, a box if nothing else is said, at rest between two pads of 20 mm that press it with 15 N.
struct HeldBox {
  GraspModel model;
  GraspState state;
  ScratchHandle scratch;
  std::vector<FingerInput> inputs{2};

  explicit HeldBox(double patch_radius, double stiffness = 5000,
                   const contact::Shape& shape = contact::Box{Vec3(0.015, 0.02, 0.025)},
                   const engine::BodyStart& start = tests::startAt(Vec3(0, 0, 0.1))) {
    engine::WorldOptions options;
    options.sleep = false;
    engine::WorldBuilder builder(options);
    builder.addBody({"box", shape, true, 0.1, {kMu, kMu, 0, 0}});
    std::vector<FingerModel> fingers = {tests::softFinger("left", stiffness), tests::softFinger("right", stiffness)};
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({i & 1 ? 1.5e-3 : -1.5e-3, i & 2 ? 9.5e-3 : -9.5e-3, i & 4 ? 9.5e-3 : -9.5e-3});
    for (FingerModel& f : fingers) {
      f.shape = contact::PadTip{contact::Polytope::hullOf(corners, "pad"), 5e-4};
      f.pad.patch_radius = patch_radius;
    }
    model = buildGrasp(builder, fingers);
    state = makeState(model, {start}, {Vec3(-0.017, 0, 0.1), Vec3(0.017, 0, 0.1)});
    scratch = makeScratch(model);
    const double in = 0.017 - 15 / stiffness;
    for (int i = 0; i < 2; ++i) inputs[static_cast<std::size_t>(i)].p_WF = Vec3(i == 0 ? -in : in, 0, 0.1);
    for (int i = 0; i < 1000; ++i) tick();
  }
  int tick() { return step(model, state, *scratch, inputs).solve.iterations; }

  // The largest share of its friction that a contact uses [-].
  double used() const {
    double used = 0;
    for (const engine::Contact& c : worldOf(*scratch).contacts)
      used =
          std::max(used, std::hypot(c.r.head<2>().norm(), c.r[engine::kTorsionRow]) / (c.mu * c.r[engine::kNormalRow]));
    return used;
  }

  // The first two contacts, of one pad, pull towards each other with `share` of their friction.
  void pull(double share) {
    engine::ContactMemory &a = state.world.contacts[0], &b = state.world.contacts[1];
    const Vec3 way_W = (b.arm_a_W - a.arm_a_W).normalized();
    const double most = share * kMu * std::min(a.r[engine::kNormalRow], b.r[engine::kNormalRow]);
    const auto add = [&](engine::ContactMemory& m, double impulse) {
      m.r[0] += impulse * m.t1_W.dot(way_W);
      m.r[1] += impulse * m.n_W.cross(m.t1_W).dot(way_W);
    };
    add(a, most);
    add(b, -most);
  }
};

// Corners that pull at each other need nothing from outside to use up their friction: nothing else would end it.
TEST(PadFriction, CornersDoNotPullAtEachOther) {
  for (const double patch_radius : {0.0, 0.004}) {
    HeldBox held(patch_radius);
    const double before = held.used();
    EXPECT_LT(before, 0.3);
    const Vec3 p = held.state.world.bodies[0].X_WI.p;
    held.pull(0.9);
    held.tick();
    EXPECT_NEAR(held.used(), before, 0.05) << patch_radius;
    EXPECT_LT((held.state.world.bodies[0].X_WI.p - p).norm(), 1e-13) << patch_radius;
  }
}

// Shares that use less than half stay: they are the body's history.
TEST(PadFriction, StaysWhereItIsWithoutNeed) {
  HeldBox held(0);
  held.pull(0.3);
  held.tick();
  EXPECT_GT(held.used(), 0.25);
}

// All of its load hung on one end of each pad's line, about which it swung for ever: 6 mm and half a radian.
TEST(PadFriction, ARodNudgedBetweenPadsPressesEvenly) {
  const auto turned = [](double angle, const Vec3& axis) { return Quat(Eigen::AngleAxisd(angle, axis)); };
  struct Case {
    contact::Shape shape;
    Quat q_WB;
  };
  for (const Case& rod : {Case{contact::Cylinder{0.015, 0.03}, turned(0.4, Vec3::UnitX())},
                          Case{contact::CylinderWithFlat{0.015, 0.012, 0.005}, turned(M_PI / 2, Vec3::UnitZ())}}) {
    HeldBox held(0, 5000, rod.shape, {{rod.q_WB, Vec3(0, 0, 0.1)}, Vec3::Zero(), Vec3(0.2, -0.1, 0.2)});
    const Vec3 p = held.state.world.bodies[0].X_WI.p;
    for (int i = 0; i < 500; ++i) held.tick();
    EXPECT_LT((held.state.world.bodies[0].X_WI.p - p).norm(), 1e-12);
    double least = 1, most = 0;
    for (const engine::Contact& c : worldOf(*held.scratch).contacts) {
      least = std::min(least, c.r[engine::kNormalRow]);
      most = std::max(most, c.r[engine::kNormalRow]);
    }
    EXPECT_GT(least, 0.9 * most);
  }
}

// It drifted for some ticks on an answer within the tolerance, was put right, and so on: a
// pinch at rest iterated in every other tick.
TEST(PadFriction, AHeldBoxComesToRest) {
  for (const double stiffness : {1000.0, 5000.0}) {
    HeldBox held(0, stiffness);
    for (int i = 0; i < 1000; ++i) held.tick();
    int iterations = 0;
    for (int i = 0; i < 1000; ++i) iterations += held.tick();
    EXPECT_EQ(iterations, 0) << stiffness;
    EXPECT_EQ(held.state.world.bodies[0].v_W, Vec3(Vec3::Zero())) << stiffness;
  }
}

// With one contact per pad it did so for ever, at 1e-10 m/s, and crept by that.
TEST(PadFriction, ANudgedBallBetweenSoftPadsComesToRest) {
  for (const double stiffness : {1000.0, 5000.0}) {
    HeldBox held(0.004, stiffness, contact::Sphere{0.015},
                 {{Quat::Identity(), Vec3(0, 0, 0.1)}, Vec3::Zero(), Vec3(0.2, -0.1, 0.2)});
    for (int i = 0; i < 2000; ++i) held.tick();
    int iterations = 0;
    for (int i = 0; i < 1000; ++i) iterations += held.tick();
    EXPECT_EQ(iterations, 0) << stiffness;
    EXPECT_EQ(held.state.world.bodies[0].v_W, Vec3(Vec3::Zero())) << stiffness;
  }
}

}  // namespace
}  // namespace pincer::grasp
