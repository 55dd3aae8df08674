// Joints: closed forms, momentum, drift.
#include "pincer/engine/world/joints.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/motion/driven_motion.h"
#include "pincer/engine/motion/one_freedom.h"
#include "pincer/engine/step.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::kGravity;
using tests::kPi;
using tests::startAt;

const Quat kAlongX = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitY()));  // turns z to x

struct Jointed {
  WorldModel model;
  WorldState state;
  WorldScratch scratch;

  Jointed(const WorldBuilder& builder, const std::vector<BodyStart>& starts)
      : model(builder.build()), state(makeState(model, starts, {})), scratch(model) {}
  StepReport tick() { return step(model, state, scratch); }
  void run(double seconds) {
    for (int n = static_cast<int>(std::lround(seconds / model.options.h)); n > 0; --n) tick();
  }
  double energy() const { return kineticEnergy(model, state) + potentialEnergy(model, state); }
  double gap() const {
    double worst = 0;
    for (const JointModel& joint : model.joints) worst = std::max(worst, jointGap(state, joint).maxCoeff());
    return worst;
  }
};

WorldOptions tickOf(double h, double g = kGravity) {
  WorldOptions options;
  options.h = h;
  options.gravity_W = Vec3(0, 0, -g);
  return options;
}

// A rod of 0.2 m that hangs on a pivot about x at its end, `angle` off the vertical.
Jointed pendulum(double h, double angle, double damping = 0) {
  WorldBuilder builder(tickOf(h));
  builder.addBody({"rod", contact::Box{Vec3(0.005, 0.005, 0.1)}, true, 0.1, {}});
  builder.addJoint({JointKind::kPivot, 0, -1, {kAlongX, Vec3(0, 0, 0.1)}, {kAlongX, Vec3(0, 0, 1)}, damping});
  const Quat q(Eigen::AngleAxisd(angle, Vec3::UnitX()));
  return {builder, {{{q, Vec3(0, 0, 1) - q * Vec3(0, 0, 0.1)}, Vec3::Zero(), Vec3::Zero()}}};
}

// Quarter period K(sin(angle/2)) sqrt(I/(m g l)), K by the arithmetic-geometric mean (Abramowitz and Stegun, 17.6.4).
double quarterPeriod(double angle) {
  const double I = 0.1 / 12 * (0.01 * 0.01 + 0.2 * 0.2) + 0.1 * 0.01;
  double a = 1, b = std::cos(0.5 * angle);
  for (int n = 0; n < 6; ++n) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return kPi / (2 * a) * std::sqrt(I / (0.1 * kGravity * 0.1));
}

// Some ticks that last a quarter period together, from the vertical's side: then it
// hangs straight down, whatever their number.
TEST(Joints, PendulumHangsStraightAfterAQuarterPeriod) {
  for (const double angle : {0.1, 1.5, kPi / 2, 2.5, 3.1}) {
    for (const int ticks : {70, 1000}) {
      Jointed world = pendulum(quarterPeriod(angle) / ticks, angle);
      for (int n = 0; n < ticks; ++n) world.tick();
      // round-off of each tick's turn, at 10 rad/s
      EXPECT_NEAR(world.state.bodies[0].X_WI.p.y(), 0, 1e-14 * ticks) << angle;
    }
  }
}

TEST(Joints, PendulumNeitherDriftsNorGainsEnergy) {
  Jointed world = pendulum(1e-3, 2);
  const double start = world.energy();
  double gap = 0, most = -1, least = 1;
  for (int i = 0; i < 60000; ++i) {
    ASSERT_EQ(world.tick().status, kStepOk);
    gap = std::max(gap, world.gap());
    most = std::max(most, world.energy() / start - 1);
    least = std::min(least, world.energy() / start - 1);
  }
  EXPECT_LT(gap, 1e-14);
  EXPECT_LT(most, 1e-11);  // 60,000 roundings of 1e-16, some of them biased
  EXPECT_GT(least, -1e-11);
}

// I w' = -d w: an exponential, whatever the axis.
TEST(Joints, DamperStopsACylinderOnItsAxis) {
  WorldBuilder builder(tickOf(1e-3));
  builder.addBody({"cylinder", contact::Cylinder{0.03, 0.05}, true, 0.4, {}});
  const double I = 0.5 * 0.4 * 0.03 * 0.03, d = 5 * I;
  builder.addJoint({JointKind::kPivot, 0, -1, {}, {Quat::Identity(), Vec3(0, 0, 0.5)}, d});
  Jointed world(builder, {startAt(Vec3(0, 0, 0.5), Vec3::Zero(), Vec3(0, 0, 10))});
  world.run(1);
  EXPECT_NEAR(bodyAngularVelocity(world.model, world.state, 0).z() / (10 * std::exp(-5.0)), 1, 1e-12);
  EXPECT_EQ(world.state.bodies[0].X_WI.p, Vec3(0, 0, 0.5));
  EXPECT_LT(world.gap(), 1e-15);
}

TEST(Joints, StiffDamperDoesNotRing) {
  Jointed world = pendulum(1e-3, 1, 1e3);
  double before = -1;
  for (int i = 0; i < 1000; ++i) {
    world.tick();
    const double w = bodyAngularVelocity(world.model, world.state, 0).x();
    EXPECT_LE(w, 0);
    EXPECT_GE(w, -1.1 * 0.1 * kGravity * 0.1 / 1e3);
    before = w;
  }
  EXPECT_LT(before, 0);
}

// A pivot between soft and stiff, where the series ends and the exponential begins: both
// give the motion of 200 times as many ticks.
TEST(Joints, DampedPendulumMovesAlikeInTicksOfAnyLength) {
  for (const double decay : {0.5, 4.0, 7.9, 8.1, 40.0}) {  // c h at 5 ms
    const double I = 0.1 / 12 * (0.01 * 0.01 + 0.2 * 0.2) + 0.1 * 0.01;
    const double damping = decay * I / 5e-3;
    Jointed coarse = pendulum(5e-3, 1.2, damping), fine = pendulum(2.5e-5, 1.2, damping);
    coarse.run(0.1);
    fine.run(0.1);
    // Beyond 8 the torque is that of the tick's middle: (h w)^2 of the way, and w is m g l / d.
    EXPECT_NEAR((coarse.state.bodies[0].X_WI.p - fine.state.bodies[0].X_WI.p).norm(), 0, decay < 8 ? 1e-13 : 1e-7)
        << decay;
  }
}

// m v' = m g sin - d v along the slider; across it nothing moves.
TEST(Joints, SliderFallsToItsTerminalSpeed) {
  WorldBuilder builder(tickOf(1e-3));
  builder.addBody({"carriage", contact::Box{Vec3(0.02, 0.01, 0.01)}, true, 0.2, {}});
  const Quat tilted(Eigen::AngleAxisd(0.6, Vec3(1, 2, 0).normalized()));
  builder.addJoint({JointKind::kSlider, 0, -1, {tilted, Vec3(0.01, 0, 0)}, {tilted, Vec3(0.01, 0, 1)}, 2});
  Jointed world(builder, {startAt(Vec3(0, 0, 1))});
  world.run(0.3);
  const Vec3 axis = tilted * Vec3::UnitZ();
  const double terminal = 0.2 * kGravity / 2 * axis.z(), tau = 0.2 / 2;
  EXPECT_NEAR(world.state.bodies[0].v_W.dot(axis), -terminal * (1 - std::exp(-0.3 / tau)), 1e-13);
  EXPECT_NEAR((world.state.bodies[0].X_WI.p - Vec3(0, 0, 1)).dot(axis),
              -terminal * (0.3 - tau * (1 - std::exp(-0.3 / tau))), 1e-13);
  EXPECT_LT(world.gap(), 1e-15);
}

// Two bars on one slider, in flight, turning about z and drifting apart along it: L = (I_1 + I_2 + mu r^2) w and E
// = (mu r'^2 + L w)/2 stay what they are, mu = m_1 m_2/(m_1 + m_2). From r' = sqrt(2 E/mu - L^2/(mu (I + mu
// r^2))), steps of 1 ms are right to 2nd order.
struct TurningSlider {
  static constexpr double m1 = 0.4, m2 = 0.1, mu = m1 * m2 / (m1 + m2),
                          I = m1 / 12 * (0.2 * 0.2 + 0.02 * 0.02) + m2 / 12 * (0.1 * 0.1 + 0.02 * 0.02);
  double r = 0.03, r_rate = 0.2, w = 6;
  Jointed world;

  explicit TurningSlider(double h) : world(make(h)) {}
  Jointed make(double h) const {
    WorldBuilder builder(tickOf(h, 0));
    builder.addBody({"rail", contact::Box{Vec3(0.1, 0.01, 0.01)}, true, m1, {}});
    builder.addBody({"carriage", contact::Box{Vec3(0.05, 0.01, 0.01)}, true, m2, {}});
    builder.excludePair(0, 1);
    builder.addJoint({JointKind::kSlider, 1, 0, {kAlongX, Vec3::Zero()}, {kAlongX, Vec3::Zero()}, 0});
    const double back = -r * m2 / (m1 + m2), ahead = r + back, back_rate = -r_rate * m2 / (m1 + m2),
                 ahead_rate = r_rate + back_rate;
    return {builder,
            {startAt(Vec3(back, 0, 0), Vec3(back_rate, w * back, 0), Vec3(0, 0, w)),
             startAt(Vec3(ahead, 0, 0), Vec3(ahead_rate, w * ahead, 0), Vec3(0, 0, w))}};
  }
  // r after so many seconds, by Runge and Kutta's method of r'' = r w^2, w = L/(I + mu r^2).
  double exactWay(double seconds) const {
    constexpr int kSteps = 20000;
    const double L = (I + mu * r * r) * w, h = seconds / kSteps;
    const auto pull = [&](double at) { return at * std::pow(L / (I + mu * at * at), 2); };
    double x = r, v = r_rate;
    for (int n = 0; n < kSteps; ++n) {
      const double a1 = pull(x), a2 = pull(x + h / 2 * v), a3 = pull(x + h / 2 * v + h * h / 4 * a1),
                   a4 = pull(x + h * v + h * h / 2 * a2);
      x += h * v + h * h / 6 * (a1 + a2 + a3);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return x;
  }
  double way() const { return (world.state.bodies[1].X_WI.p - world.state.bodies[0].X_WI.p).norm(); }
  double angularMomentum() const {
    double sum = 0;
    for (const BodyState& body : world.state.bodies) sum += body.L_W.z();
    return sum + m1 * world.state.bodies[0].X_WI.p.cross(world.state.bodies[0].v_W).z() +
           m2 * world.state.bodies[1].X_WI.p.cross(world.state.bodies[1].v_W).z();
  }
};

TEST(Joints, ASliderThatTurnsFarFromItsOriginKeepsItsAngularMomentum) {
  TurningSlider pair(1e-3);
  const double L = pair.angularMomentum(), E = pair.world.energy();
  EXPECT_NEAR(L, (pair.I + pair.mu * pair.r * pair.r) * pair.w, 1e-15);
  pair.world.run(0.5);
  EXPECT_GT(pair.way(), 0.3);
  EXPECT_NEAR(pair.angularMomentum() / L, 1, 1e-5);  // of 2nd order in the tick, 2e-6 here
  EXPECT_NEAR(pair.world.energy() / E, 1, 1e-5);
}

TEST(Joints, ASliderThatTurnsGoesAsFarAsItsEquationSaysToSecondOrder) {
  const double exact = TurningSlider(1e-3).exactWay(0.5);
  double error[2];
  for (const int k : {0, 1}) {
    TurningSlider pair(k == 0 ? 1e-3 : 5e-4);
    pair.world.run(0.5);
    error[k] = std::abs(pair.way() - exact);
  }
  EXPECT_LT(error[0], 1e-5);
  EXPECT_NEAR(error[0] / error[1], 4, 0.4);
}

// A ball hits a door at distance b from its hinge, e = 1: angular momentum about the hinge and energy are kept, so that
// w = 2 m v b / (I + m b^2) and the ball leaves with v (m b^2 - I)/(m b^2 + I).
TEST(Joints, BallOpensADoorAsMomentumAndEnergySay) {
  WorldBuilder builder(tickOf(1e-3, 0));
  const Material elastic{0, 0, 1, 0};
  builder.addBody({"door", contact::Box{Vec3(0.1, 0.005, 0.1)}, true, 0.3, elastic});
  builder.addBody({"ball", contact::Sphere{0.01}, true, 0.05, elastic});
  builder.addJoint(
      {JointKind::kPivot, 0, -1, {Quat::Identity(), Vec3(-0.1, 0, 0)}, {Quat::Identity(), Vec3(-0.1, 0, 0)}, 0});
  Jointed world(builder, {startAt(Vec3::Zero()), startAt(Vec3(0.06, -0.0205, 0), Vec3(0, 1.3, 0))});
  world.run(0.02);
  const double I = 0.3 / 12 * (0.2 * 0.2 + 0.01 * 0.01) + 0.3 * 0.01, b = 0.16, mbb = 0.05 * b * b;
  EXPECT_NEAR(bodyAngularVelocity(world.model, world.state, 0).z(), 2 * 0.05 * 1.3 * b / (I + mbb), 1e-8);
  EXPECT_NEAR(world.state.bodies[1].v_W.y(), 1.3 * (mbb - I) / (mbb + I), 1e-8);
  EXPECT_LT(world.gap(), 1e-15);
}

// A bar on a hinge at its left end lies on a ball's top at its right: the ball
// carries half of the bar's weight, exactly.
TEST(Joints, HingedBarRestsOnASupport) {
  WorldBuilder builder(tickOf(1e-3));
  const Material smooth{0, 0, 0, 0};  // friction on a bar that its hinge holds could be anything
  builder.addBody({"bar", contact::Box{Vec3(0.1, 0.02, 0.01)}, true, 0.3, smooth});
  builder.addBody({"post", contact::Sphere{0.01}, false, 0, smooth});
  const Quat along_y(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitX()));
  builder.addJoint({JointKind::kPivot, 0, -1, {along_y, Vec3(-0.1, 0, 0)}, {along_y, Vec3(-0.1, 0, 0)}, 0});
  Jointed world(builder, {startAt(Vec3::Zero()), startAt(Vec3(0.1 - 1e-3, 0, -0.02))});
  world.run(0.5);
  ASSERT_EQ(world.scratch.contacts.size(), 1U);
  EXPECT_NEAR(world.scratch.contacts[0].impulse_W.z() / 1e-3, 0.3 * kGravity * 0.1 / 0.199, 1e-8);
  EXPECT_NEAR(world.state.bodies[0].X_WI.p.z(), 0, 1e-9);
}

// Two halves of a rod, welded: they tumble like the whole.
TEST(Joints, WeldMakesOneBodyOfTwo) {
  WorldBuilder halves(tickOf(1e-3, 0)), whole(tickOf(1e-3, 0));
  for (const char* name : {"left", "right"})
    halves.addBody({name, contact::Box{Vec3(0.05, 0.01, 0.015)}, true, 0.1, {}});
  halves.addJoint(
      {JointKind::kWeld, 0, 1, {Quat::Identity(), Vec3(0.05, 0, 0)}, {Quat::Identity(), Vec3(-0.05, 0, 0)}, 0});
  whole.addBody({"rod", contact::Box{Vec3(0.1, 0.01, 0.015)}, true, 0.2, {}});
  const Vec3 v(0.1, 0, 0), w(3, 2, 5);
  const auto at = [&](double x) { return startAt(Vec3(x, 0, 0), v + w.cross(Vec3(x, 0, 0)), w); };
  Jointed two(halves, {at(-0.05), at(0.05)}), one(whole, {at(0)});
  two.run(1);
  one.run(1);
  const Vec3 middle = 0.5 * (two.state.bodies[0].X_WI.p + two.state.bodies[1].X_WI.p);
  EXPECT_NEAR((middle - Vec3(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_LT(two.gap(), 1e-14);
  EXPECT_LT(
      rotationVectorOf(bodyPose(two.model, two.state, 0).q.conjugate() * bodyPose(one.model, one.state, 0).q).norm(),
      1e-4);
  EXPECT_NEAR(two.energy() / one.energy(), 1, 1e-4);
}

// A shelf that two welds hold to the world: the first takes all six freedoms. Room for a seventh direction of the basis
// was written to past its end, which the sanitized run sees; what lies on the shelf stays there.
TEST(Joints, AShelfWeldedTwiceCarriesABall) {
  WorldBuilder builder(tickOf(1e-3));
  builder.addBody({"shelf", contact::Box{Vec3(0.1, 0.05, 0.005)}, true, 0.2, {}});
  builder.addBody({"ball", contact::Sphere{0.02}, true, 0.1, {}});
  for (const double x : {-0.1, 0.1}) {
    const Pose X{Quat::Identity(), Vec3(x, 0, 0)};
    builder.addJoint({JointKind::kWeld, 0, -1, X, X, 0});
  }
  Jointed world(builder, {startAt(Vec3::Zero()), startAt(Vec3(0.03, 0, 0.025))});
  world.run(0.3);
  EXPECT_LT(world.state.bodies[0].X_WI.p.norm(), 1e-12);
  EXPECT_NEAR(world.state.bodies[1].X_WI.p.z(), 0.025, 1e-9);
}

// Scissors in free flight: a pivot between two bodies keeps momentum and angular momentum.
TEST(Joints, PivotBetweenTwoBodiesKeepsTheirMomenta) {
  WorldBuilder builder(tickOf(1e-3, 0));
  for (const char* name : {"blade", "other"})
    builder.addBody({name, contact::Box{Vec3(0.06, 0.008, 0.002)}, true, 0.05, {}});
  builder.addJoint(
      {JointKind::kPivot, 0, 1, {Quat::Identity(), Vec3(-0.04, 0, 0)}, {Quat::Identity(), Vec3(-0.04, 0, 0)}, 1e-5});
  const Vec3 hinge(-0.04, 0, 0);
  const auto spinning = [&](double w) { return startAt(Vec3::Zero(), Vec3(0, 0, w).cross(-hinge), Vec3(0, 0, w)); };
  Jointed world(builder, {spinning(8), spinning(-3)});
  const auto momentum = [&] { return Vec3(0.05 * (world.state.bodies[0].v_W + world.state.bodies[1].v_W)); };
  const auto spin = [&] {
    Vec3 L = Vec3::Zero();
    for (const BodyState& b : world.state.bodies) L += b.L_W + 0.05 * b.X_WI.p.cross(b.v_W);
    return L;
  };
  const Vec3 P = momentum(), L = spin();
  const double energy = world.energy();
  world.run(2);
  EXPECT_LT((momentum() - P).norm(), 1e-15);
  // poses are projected along the inertia of the tick's middle: second order
  EXPECT_LT((spin() - L).norm(), 2e-6 * L.norm());
  EXPECT_LT(world.gap(), 1e-14);
  EXPECT_LE(world.energy(), energy * (1 + 1e-6));
}

// A knob that fingers turned lagged behind them by (c h)^2 / 12 of the way: what contacts gave a
// damped coordinate counted by half on the way.
TEST(Joints, ADampedCoordinateGoesAsFarAsAConstantPushTakesIt) {
  for (const double ch : {0.0, 1e-9, 1e-3, 0.0999, 0.1001, 1.0, 30.0}) {
    const long double h = 1e-3L, c = static_cast<long double>(ch) / h, x = c * h;
    const long double rate = x > 0 ? -std::expm1(-x) / c : h;  // of a push of 1
    const long double way =
        x > 1e-2L ? h / c - rate / c : h * h * (0.5L - x / 6 + x * x / 24 - x * x * x / 120 + x * x * x * x / 720);
    const double w = 0.3, push = 2.1;
    const OneFreedomCourse course = followFreedom({push, 0, static_cast<double>(c), false}, w, 1e-3);
    const OneFreedomCourse free = followFreedom({0, 0, static_cast<double>(c), false}, w, 1e-3);
    EXPECT_NEAR(dampedWay(static_cast<double>(c), 1e-3), static_cast<double>(way / (h * rate)), 1e-13) << ch;
    EXPECT_NEAR(free.way + dampedWay(static_cast<double>(c), 1e-3) * 1e-3 * (course.rate - free.rate), course.way,
                1e-16)
        << ch;
  }
}

// Bodies joined at the wrong place are refused, and so is a joint that holds nothing.
TEST(Joints, StartApartIsRefused) {
  WorldBuilder builder(tickOf(1e-3));
  builder.addBody({"rod", contact::Sphere{0.01}, true, 0.1, {}});
  builder.addBody({"wall", contact::HalfSpace{}, false, 0, {}});
  EXPECT_THROW(builder.addJoint({JointKind::kPivot, 1, -1, {}, {}, 0}), InputError);
  EXPECT_THROW(builder.addJoint({JointKind::kPivot, 0, 7, {}, {}, 0}), InputError);
  builder.addJoint({JointKind::kBall, 0, -1, {}, {}, 0});
  const WorldModel model = builder.build();
  EXPECT_THROW(makeState(model, {startAt(Vec3(0, 0, 0.001)), startAt(Vec3(0, 0, -1))}, {}), InputError);
  EXPECT_NO_THROW(makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, -1))}, {}));
}

TEST(Joints, AllocateNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Jointed world = pendulum(1e-3, 2, 1e-4);
  const auto before = tests::allocationCount();
  for (int i = 0; i < 200; ++i) world.tick();
  EXPECT_EQ(tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::engine
