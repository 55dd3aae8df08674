// Soft pads, fingers that turn, friction that falls with speed, and couplings along the contact's own axes.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kPressMu = 0.5;

// One finger, r 8 mm, pressed 2 mm (2 N) onto a plate that never moves, led from there.
struct PressedFinger {
  GraspModel model;
  GraspState state;
  GraspScratch scratch;
  std::vector<FingerInput> input = std::vector<FingerInput>(1);

  static GraspModel make(const FingerModel& finger, const engine::Material& material) {
    engine::WorldOptions options;
    options.gravity_W.setZero();
    engine::WorldBuilder builder(options);
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, material});
    return buildGrasp(builder, {finger});
  }
  PressedFinger(const FingerModel& finger, const engine::Material& material)
      : model(make(finger, material)),
        state(makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 8e-3)})),
        scratch(model) {
    input[0].p_WF = Vec3(0, 0, 8e-3);
    for (int i = 0; i < 100; ++i) lead(Vec3(0, 0, 8e-3 - 2e-5 * (i + 1)));
    for (int i = 0; i < 100; ++i) lead(input[0].p_WF);
  }
  void lead(const Vec3& p) {
    input[0].v_WF = (p - input[0].p_WF) / 1e-3;
    input[0].p_WF = p;
    step(model, state, scratch, input);
  }
  void turn(const Vec3& axis, double angle) { input[0].q_WF = Quat(Eigen::AngleAxisd(angle, axis)); }
  const FingerReport& felt() const { return scratch.fingers[0]; }
};

TEST(SoftFinger, PatchGrowsWithTheCubeRootOfTheLoad) {
  const SoftPad pad{.modulus = 1e5};
  EXPECT_DOUBLE_EQ(patchRadius(pad, 8e-3, 8) / patchRadius(pad, 8e-3, 1), 2);
  EXPECT_DOUBLE_EQ(patchRadius(pad, 8e-3, 2), std::cbrt(0.75 * 2 * 8e-3 / 1e5));
  EXPECT_DOUBLE_EQ(torsionRadius({.patch_radius = 6e-3}, 8e-3, 1), 4e-3);
  EXPECT_DOUBLE_EQ(torsionRadius(pad, 8e-3, 2), 3 * tests::kPi / 16 * patchRadius(pad, 8e-3, 2));
  EXPECT_GT(torsionRadius(pad, 8e-3, 0), 0);  // so that a contact's rows don't come and go
}

TEST(SoftFinger, SlidesAndTurnsOnTheLimitSurface) {
  FingerModel finger = tests::softFinger("soft");
  finger.pad.modulus = 1e5;
  PressedFinger f(finger, {kPressMu, kPressMu, 0, 0});
  const double v = 0.02, w = 5;
  for (int i = 1; i <= 600; ++i) {
    f.turn(Vec3::UnitZ(), w * 1e-3 * i);
    f.lead(f.input[0].p_WF + Vec3(v * 1e-3, 0, 0));
  }
  const double e = torsionRadius(finger.pad, 8e-3, f.felt().normal_force), limit = kPressMu * f.felt().normal_force;
  EXPECT_NEAR(std::hypot(f.felt().tangential_force / limit, f.felt().torsion / (e * limit)), 1, 1e-9);
  EXPECT_NEAR(std::abs(f.felt().torsion) / f.felt().tangential_force, e * e * w / v, 1e-3 * e * e * w / v);
  EXPECT_TRUE(f.felt().sliding);
  EXPECT_DOUBLE_EQ(f.felt().patch_radius, patchRadius(finger.pad, 8e-3, f.felt().normal_force));
}

TEST(SoftFinger, TwistSpringCarriesTorsionUntilItSlips) {
  FingerModel finger = tests::softFinger("soft");
  finger.pad.patch_radius = 5e-3;
  finger.coupling.twist_stiffness = 0.2;
  PressedFinger f(finger, {kPressMu, kPressMu, 0, 0});
  for (int i = 1; i <= 200; ++i) {
    f.turn(Vec3::UnitZ(), 5e-5 * i);
    f.lead(f.input[0].p_WF);
  }
  EXPECT_NEAR(std::abs(f.felt().torsion), 0.2 * 0.01, 1e-9);
  EXPECT_FALSE(f.felt().sliding);
  for (int i = 1; i <= 300; ++i) {
    f.turn(Vec3::UnitZ(), 0.01 + 5e-5 * i);
    f.lead(f.input[0].p_WF);
  }
  const double limit = kPressMu * f.felt().normal_force * 2.0 / 3 * 5e-3;
  EXPECT_NEAR(std::abs(f.felt().torsion), limit, 1e-9 * limit);
  EXPECT_TRUE(f.felt().sliding);
}

// The spring's axis is the contact's normal, what is locked are the world's axes: a finger that may only press
// along x held nothing that it could twist on.
TEST(SoftFinger, LockedAxesStayTheWorldsWhereThePadTwists) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.05, {0.8, 0.8, 0, 0}});
  std::vector<FingerModel> fingers = {tests::softFinger("left"), tests::softFinger("right")};
  for (FingerModel& f : fingers) {
    f.coupling.locked = {false, true, true};
    f.coupling.twist_stiffness = 0.3;
    f.pad.patch_radius = 5e-3;
  }
  tests::GraspWorld w{buildGrasp(builder, fingers), {}};
  w.state = makeState(w.model, {tests::startAt(Vec3(0, 0, 0.1))}, {Vec3(-0.028, 0, 0.1), Vec3(0.028, 0, 0.1)});
  GraspScratch scratch(w.model);
  const auto inputs = tests::squeezing(2e-3);
  for (int i = 0; i < 1000; ++i) {
    step(w.model, w.state, scratch, inputs);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(w.state.world.points[k].p_W.y(), inputs[k].p_WF.y());
      EXPECT_EQ(w.state.world.points[k].p_W.z(), inputs[k].p_WF.z());
    }
  }
  EXPECT_GT(scratch.fingers[0].normal_force, 1);
  EXPECT_LT(w.state.world.bodies[0].v_W.norm(), 1e-9);
}

// A rigid finger on a body in its hand: the body turns with it, and with a twist
// spring it lags by the torque that turns it.
TEST(SoftFinger, TurnsWhatItHolds) {
  for (const double stiffness : {0.0, 0.5}) {
    tests::GraspWorld w = tests::pinchedBall(0.05, 0.8);
    for (FingerModel& f : w.model.fingers) f.pad.patch_radius = 5e-3;
    for (engine::DrivenPointModel& p : w.model.world.points) p.twist_stiffness = stiffness;
    for (FingerModel& f : w.model.fingers) f.coupling.twist_stiffness = stiffness;
    GraspScratch scratch(w.model);
    auto inputs = tests::squeezing(2e-3);
    for (int i = 0; i < 200; ++i) step(w.model, w.state, scratch, inputs);
    for (int i = 1; i <= 500; ++i) {
      for (auto& input : inputs) input.q_WF = Quat(Eigen::AngleAxisd(1e-3 * i, Vec3::UnitX()));
      step(w.model, w.state, scratch, inputs);
    }
    for (int i = 0; i < 500; ++i) step(w.model, w.state, scratch, inputs);
    const Quat& q = w.state.world.bodies[0].X_WI.q;
    EXPECT_NEAR(angleBetween(q, Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX()))), 0, 2e-3) << stiffness;
  }
}

// Pure rolling on a plane: no slip, no friction needed, and the place moves over the pad as fast as over the plane.
TEST(TurningFinger, RollsWithoutSlip) {
  PressedFinger f(tests::softFinger("round", 1000, 0), {kPressMu, kPressMu, 0, 0});
  const double w = 2;
  double angle = 0, x = 0;
  for (int i = 1; i <= 500; ++i) {
    const double rate = w * std::min(1.0, i / 200.0);
    angle += rate * 1e-3;
    x += rate * 1e-3 * 8e-3;
    f.turn(Vec3::UnitY(), angle);
    f.lead(Vec3(x, 0, 6e-3));
  }
  EXPECT_FALSE(f.felt().sliding);
  EXPECT_NEAR(placeRateOnPad(f.model.fingers[0], f.felt(), 1e-3).norm(), 8e-3 * w, 1e-6 * 8e-3 * w);
  EXPECT_LT(f.felt().tangential_force, 0.05 * f.felt().normal_force);  // what the spring's lag of a tick pulls
  // of the middle of the tick
  EXPECT_NEAR(placeOnPad(f.model.fingers[0], f.felt().touch).norm(), 8e-3 * angle, 8e-3 * 1.1e-3 * w);
}

TEST(TurningFinger, DragsWhatItTouchesSideways) {
  PressedFinger f(tests::softFinger("round"), {kPressMu, kPressMu, 0, 0});
  for (int i = 1; i <= 300; ++i) {
    f.turn(Vec3::UnitY(), 1e-3 * i);
    f.lead(Vec3(0, 0, 6e-3));  // the device stays: the tip turns on the spot and its skin slides
  }
  EXPECT_NEAR(f.felt().tangential_force, kPressMu * f.felt().normal_force, 1e-9);
}

TEST(Stribeck, FrictionFallsWithSpeed) {
  const engine::Material m{.mu_s = 0.8, .mu_d = 0.4, .stribeck_speed = 0.02};
  EXPECT_DOUBLE_EQ(engine::slidingFriction(m, 0), 0.8);
  EXPECT_DOUBLE_EQ(engine::slidingFriction(m, 0.02), 0.4 + 0.4 * std::exp(-1.0));
  EXPECT_NEAR(engine::slidingFriction(m, 0.2), 0.4, 1e-15);
  engine::Material plain = m;
  plain.stribeck_speed = 0;
  EXPECT_EQ(engine::slidingFriction(plain, 0.001), 0.4);
  for (const double v : {0.01, 0.03, 0.2}) {
    PressedFinger f(tests::softFinger("finger", 1000, 100), m);  // damped enough not to stick and slip by turns
    for (int i = 0; i < 3000; ++i) f.lead(f.input[0].p_WF + Vec3(v * 1e-3, 0, 0));
    EXPECT_NEAR(f.felt().tangential_force / f.felt().normal_force, engine::slidingFriction(m, v), 1e-6) << v;
  }
}

// It slips at mu_s and then not again until the load has fallen below mu_d: the loop of hysteresis.
TEST(Stribeck, SticksAgainBelowDynamicFriction) {
  PressedFinger f(tests::softFinger("finger"), {.mu_s = 0.8, .mu_d = 0.4});
  const auto loaded = [&](double share) {
    f.input[0].f_W = Vec3(share * f.felt().normal_force, 0, 0);
    f.lead(f.input[0].p_WF);
    return f.felt().sliding;
  };
  EXPECT_FALSE(loaded(0.79));
  EXPECT_FALSE(loaded(0.79));
  EXPECT_TRUE(loaded(0.81));
  EXPECT_TRUE(loaded(0.7));  // above mu_d it goes on
  bool slides = true;
  for (int i = 0; i < 300; ++i) slides = loaded(0.3);
  EXPECT_FALSE(slides);
  EXPECT_FALSE(loaded(0.7));  // and holds again up to mu_s
}

TEST(CouplingAxes, NormalAndTangentialStiffnessAreTheContacts) {
  FingerModel finger = tests::softFinger("finger");
  finger.along_normal = true;
  finger.coupling.stiffness = Vec3(300, 300, 2000);
  finger.coupling.damping = Vec3(1, 1, 4);
  for (const Vec3& n : {Vec3(0, 0, 1), Vec3(Vec3(1, -2, 3).normalized())}) {
    engine::WorldOptions options;
    options.gravity_W.setZero();
    engine::WorldBuilder builder(options);
    builder.addBody({"plate", contact::HalfSpace{}, false, 0, {2, 2, 0, 0}});
    const GraspModel model = buildGrasp(builder, {finger});
    engine::BodyStart plate;
    plate.X_WB.q = Quat::FromTwoVectors(Vec3::UnitZ(), n);
    GraspState state = makeState(model, {plate}, {8e-3 * n});
    GraspScratch scratch(model);
    std::vector<FingerInput> input(1);
    const Vec3 t = frameFromNormal(n).col(1);
    for (int i = 0; i < 600; ++i) {
      input[0].p_WF = (8e-3 - 1e-3 * std::min(1.0, i / 100.0)) * n + 1e-3 * std::clamp((i - 200) / 100.0, 0.0, 1.0) * t;
      step(model, state, scratch, input);
    }
    EXPECT_NEAR(scratch.fingers[0].normal_force, 2000 * 1e-3, 1e-9);
    EXPECT_NEAR(scratch.fingers[0].tangential_force, 300 * 1e-3, 1e-9);
  }
}

TEST(CouplingAxes, LockedAxesDontGoWithThem) {
  FingerModel finger = tests::softFinger("finger");
  finger.along_normal = true;
  finger.coupling.locked = {true, false, false};
  EXPECT_NE(tests::errorOf([&] { PressedFinger::make(finger, {}); }).find("locked axes are the world's"),
            std::string::npos);
}

TEST(SoftFinger, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  FingerModel finger = tests::softFinger("soft");
  finger.pad.modulus = 1e5;
  finger.coupling.twist_stiffness = 0.2;
  finger.along_normal = true;
  finger.shape = contact::EllipsoidTip{Vec3(9e-3, 8e-3, 8e-3)};
  PressedFinger f(finger, {kPressMu, kPressMu, 0, 0});
  const auto before = tests::allocationCount();
  for (int i = 1; i <= 100; ++i) {
    f.turn(Vec3(1, 1, 1).normalized(), 1e-3 * i);
    f.lead(Vec3(1e-5 * i, 0, 6e-3));
  }
  EXPECT_EQ(tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::grasp
