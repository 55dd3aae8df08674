// Passivity: no energy from nothing at the fingers, whatever the wall, the body or the hand.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pincer/grasp/energy_ledger.h"
#include "pincer/grasp/passivity.h"
#include "pincer/grasp/tick/scratch.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::grasp {
namespace {

constexpr double kTick = 1e-3;
constexpr std::size_t kMostFingers = 3;

PassivityOptions controlling() {
  PassivityOptions options;
  options.on = true;
  options.arms.assign(kMostFingers, {0.1, 0.5});
  return options;
}

// An arm along x: mass, viscous friction, and the force that is held for a tick; integrated finely.
struct HeldArm {
  double mass = 0.1, friction = 0.5, x = 0, v = 0;
  void advance(double f_held, double f_hand) {
    constexpr int kParts = 20;
    for (int i = 0; i < kParts; ++i) {
      v += (f_held + f_hand - friction * v) / mass * kTick / kParts;
      x += v * kTick / kParts;
    }
  }
};

// A wall at x = 0 of stiffness K, hit at 0.2 m/s by an arm that a constant force presses against it.
struct WallRun {
  double least_energy = 0;  // that came in, the arm's friction counted: what the hand got is its negative [J]
  double largest_late = 0;  // excursion in the last tenth of the run [m]
};
WallRun hitWall(double stiffness, const PassivityOptions& options, double pressing = 0) {
  HeldArm arm{.x = 0.01, .v = -0.2};
  PassivityState state(1);
  std::vector<Vec3> f(1), p(1);
  WallRun run;
  double lost = 0;  // to the arm's friction [J]
  constexpr int kTicks = 3000;
  for (int i = 0; i < kTicks; ++i) {
    p[0] = Vec3(arm.x, 0, 0);
    f[0] = Vec3(arm.x < 0 ? -stiffness * arm.x : 0, 0, 0);
    observePorts(options, p, arm.x < 0 ? 0.5 * stiffness * arm.x * arm.x : 0, kTick, state);
    controlPorts(options, kTick, state, f);
    holdPorts(f, state);
    arm.advance(f[0].x(), -pressing);
    run.least_energy = std::min(run.least_energy, state.energy() + lost);
    lost += arm.friction * (arm.x - p[0].x()) * (arm.x - p[0].x()) / kTick;
    if (i > kTicks * 9 / 10) run.largest_late = std::max(run.largest_late, std::abs(arm.x));
  }
  return run;
}

TEST(Passivity, ObserverCountsTheHeldForcesWorkExactly) {
  PassivityState state(2);
  const PassivityOptions off;
  std::vector<Vec3> p = {Vec3(1, 2, 3), Vec3::Zero()}, f = {Vec3(0.5, 0, -2), Vec3(1, 0, 0)};
  observePorts(off, p, 0, kTick, state);
  holdPorts(f, state);
  p[0] += Vec3(0.25, 4, 0.5);
  p[1] += Vec3(-0.5, 0, 0);
  observePorts(off, p, 0, kTick, state);
  EXPECT_EQ(state.ports[0].energy, -(0.5 * 0.25 - 2 * 0.5));
  EXPECT_EQ(state.ports[1].energy, 0.5);
  EXPECT_EQ(state.energy(), 0.875 + 0.5);
}

TEST(Passivity, OffItChangesNoForce) {
  PassivityState state(1);
  std::vector<Vec3> p = {Vec3::Zero()}, f = {Vec3(3, 0, 0)};
  for (int i = 0; i < 5; ++i) {
    p[0].x() += 1e-3;
    observePorts({}, p, 0, kTick, state);
    f[0] = Vec3(3, 0, 0);
    controlPorts({}, kTick, state, f);
    EXPECT_EQ(f[0], Vec3(3, 0, 0));
    holdPorts(f, state);
  }
  EXPECT_LT(state.energy(), -0.01);
}

// Colgate & Schenkel: K <= 2 b / T = 1000 N/m is passive; ten times that buzzes, and
// makes energy for as long as it is pressed.
TEST(Passivity, WallBeyondTheBoundOfTheoryMakesEnergyOnlyWithoutTheController) {
  const WallRun free = hitWall(10000, {}, 2), held = hitWall(10000, controlling(), 2);
  EXPECT_LT(free.least_energy, -0.02);
  // what the pressing of 2 N, unknown to the controller, moves within a tick: f^2 h^2 / 2m = 2e-5 J
  EXPECT_GT(held.least_energy, -1e-5);
  EXPECT_LT(held.largest_late, 0.5 * free.largest_late);
}

TEST(Passivity, WallWithinTheBoundIsLeftAlone) {
  const WallRun free = hitWall(800, {}), held = hitWall(800, controlling());
  EXPECT_GE(free.least_energy, -1e-9);
  EXPECT_GE(held.least_energy, -1e-9);
  // the look ahead errs by what the hand does in a tick
  EXPECT_NEAR(free.largest_late, held.largest_late, 0.01 * free.largest_late);
}

TEST(Passivity, DampsWithAtMostThirtyAndNeverTurnsAForceRound) {
  tests::RandomNumbers random(7);
  PassivityOptions options = controlling();
  options.bound = false;
  options.arms.assign(kMostFingers, {0.1, 0});
  PassivityState state(3);
  std::vector<Vec3> p(3, Vec3::Zero()), f(3);
  for (int i = 0; i < 2000; ++i) {
    for (Vec3& x : p) x += 1e-4 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    for (Vec3& x : f) x = 5 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const std::vector<Vec3> wanted = f;
    observePorts(options, p, 0, kTick, state);
    controlPorts(options, kTick, state, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 change = f[k] - wanted[k], v = state.ports[k].v_W;
      EXPECT_LE(change.norm(), options.most_damping * v.norm() * (1 + 1e-12));
      EXPECT_LE(change.dot(v), 0);
      EXPECT_LT(change.cross(v).norm(), 1e-12);
    }
    holdPorts(f, state);
  }
  EXPECT_GT(state.acted, 100);
}

TEST(Passivity, FingerAtRestIsLeftAloneAndItsDebtIsCarriedOver) {
  PassivityOptions options = controlling();
  options.bound = false;
  options.arms.assign(kMostFingers, {0.1, 0});
  PassivityState state(1);
  std::vector<Vec3> p = {Vec3::Zero()}, f = {Vec3(2, 0, 0)};
  observePorts(options, p, 0, kTick, state);
  controlPorts(options, kTick, state, f);
  EXPECT_EQ(f[0], Vec3(2, 0, 0));
  holdPorts(f, state);
  p[0].x() += 1e-3;  // the held force pays out 2 mJ
  observePorts(options, p, 0, kTick, state);
  EXPECT_DOUBLE_EQ(state.balance, -2e-3);
  for (int i = 0; i < 10; ++i) {  // at rest: nothing to brake
    observePorts(options, p, 0, kTick, state);
    f[0] = Vec3(2, 0, 0);
    controlPorts(options, kTick, state, f);
    EXPECT_EQ(f[0], Vec3(2, 0, 0));
    holdPorts(f, state);
  }
  p[0].x() -= 1e-3;  // pushed back: the debt is paid
  observePorts(options, p, 0, kTick, state);
  EXPECT_NEAR(state.balance, 0, 1e-18);
}

// One finger may take out the energy that another puts in: an n-port. Alone, the second would have to be passive.
TEST(Passivity, EnergyMayPassFromFingerToFinger) {
  for (const bool each : {false, true}) {
    PassivityOptions options = controlling();
    options.each = each;
    PassivityState state(2);
    std::vector<Vec3> p(2, Vec3::Zero()), f(2);
    bool changed = false;
    for (int i = 0; i < 100; ++i) {  // finger 0 pushes against 1 N, finger 1 is pushed with 0.7 N
      for (Vec3& x : p) x.x() += 1e-4;
      f = {Vec3(-1, 0, 0), Vec3(0.7, 0, 0)};
      observePorts(options, p, 1, kTick, state);
      controlPorts(options, kTick, state, f);
      if (i > 1) changed = changed || f[1].x() < 0.7;  // at first nothing has come in
      EXPECT_EQ(f[0].x(), i > 1 ? -1 : f[0].x());
      holdPorts(f, state);
    }
    EXPECT_EQ(changed, each);
  }
}

// Energy lost to friction is no credit: the balance never exceeds what the world stores.
TEST(Passivity, DissipatedEnergyIsNoCredit) {
  PassivityState state(1);
  const PassivityOptions options = controlling();
  std::vector<Vec3> p = {Vec3::Zero()}, f = {Vec3(-1, 0, 0)};
  for (int i = 0; i < 1000; ++i) {
    p[0].x() += 1e-3;
    observePorts(options, p, 0.01, kTick, state);
    holdPorts(f, state);
  }
  EXPECT_NEAR(state.energy(), 0.999, 1e-9);
  EXPECT_EQ(state.balance, 0);  // the world stores no more than at the start
}

TEST(Passivity, OptionsOutOfRangeAreNamed) {
  const auto refusal = [](auto change) {
    PassivityOptions options;
    options.arms = {ArmPort{}};
    change(options);
    return tests::errorOf([&] { check(options); });
  };
  EXPECT_EQ(refusal([](PassivityOptions&) {}), "");
  const auto expectNamed = [&](auto change, const char* says) {
    const std::string said = refusal(change);
    EXPECT_NE(said.find(says), std::string::npos) << says << ", not: " << said;
  };
  expectNamed([](auto& o) { o.most_damping = -1; }, "most_damping = -1 is out of range");
  expectNamed([](auto& o) { o.most_damping = 1001; }, "most_damping = 1001 is out of range");
  expectNamed([](auto& o) { o.still_speed = 0; }, "still_speed = 0 is out of range");
  expectNamed([](auto& o) { o.reserve = -1; }, "reserve = -1 is out of range");
  expectNamed([](auto& o) { o.arms[0].mass = 0; }, "mass of an arm = 0 is out of range");
  expectNamed([](auto& o) { o.arms[0].damping = -2; }, "damping of an arm = -2 is out of range");
}

// Two simulated hands with random wishes squeeze and shake a ball of 500 g, at
// stiffnesses beyond what their arms can carry.
struct Hands {
  double least = 0;  // energy that came in, the arms' friction counted, least [J]
};
Hands shakeBall(double stiffness, const PassivityOptions& options, std::uint64_t seed) {
  tests::GraspWorld w = tests::pinchedBall(0.5, 0.6, stiffness);
  w.model.world.options.gravity_W.setZero();
  GraspScratch scratch(w.model);
  tests::RandomNumbers random(seed);
  PassivityState state(2);
  std::array<std::array<HeldArm, 3>, 2> arms;
  for (int i = 0; i < 2; ++i) {
    arms[i][0].x = i == 0 ? -0.028 : 0.028;
    arms[i][2].x = 0.1;
  }
  std::vector<Vec3> p(2), f(2), wish(2, Vec3::Zero());
  std::vector<FingerInput> inputs(2);
  for (int i = 0; i < 2; ++i) inputs[i].p_WF = Vec3(arms[i][0].x, arms[i][1].x, arms[i][2].x);
  Hands hands;
  double lost = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    for (int i = 0; i < 2; ++i) {
      const double side = i == 0 ? -1 : 1;
      if (tick % 50 == 0)
        wish[i] = Vec3(side * (0.022 + random.uniform(-2e-3, 2e-3)), random.uniform(-3e-3, 3e-3),
                       0.1 + random.uniform(-3e-3, 3e-3));
      for (int k = 0; k < 3; ++k) arms[i][k].advance(f[i][k], 800 * (wish[i][k] - arms[i][k].x) - arms[i][k].v);
      const Vec3 before = p[i];
      p[i] = Vec3(arms[i][0].x, arms[i][1].x, arms[i][2].x);
      if (tick > 0) lost += 0.5 * (p[i] - before).squaredNorm() / kTick;
      inputs[i].v_WF = (p[i] - inputs[i].p_WF) / kTick;
      inputs[i].p_WF = p[i];
    }
    step(w.model, w.state, scratch, inputs);
    for (int i = 0; i < 2; ++i) f[i] = scratch.fingers[i].f_user_W;
    observePorts(options, p, storedEnergy(w.model, w.state), kTick, state);
    controlPorts(options, kTick, state, f);
    holdPorts(f, state);
    hands.least = std::min(hands.least, state.energy() + lost);
  }
  return hands;
}

TEST(Passivity, RandomHandsGetNoEnergyOut) {
  double free = 0, held = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    free = std::min(free, shakeBall(1e5, {}, seed).least);
    held = std::min(held, shakeBall(1e5, controlling(), seed).least);
  }
  EXPECT_LT(free, -1e-2);
  EXPECT_GT(held, -1e-3) << free;
}

TEST(EnergyLedger, AddsUp) {
  tests::GraspWorld w = tests::pinchedBall(0.075, 0.6);
  w.model.world.options.gravity_W.setZero();
  GraspScratch scratch(w.model);
  EnergyLedger ledger(w.model, w.state);
  double held = 0;
  Vec3 f_last = Vec3::Zero(), x_last = Vec3(-0.028, 0, 0.1);
  for (int i = 0; i < 600; ++i) {
    // squeeze, then lift
    auto inputs = tests::squeezing(2e-3 * std::min(1.0, i / 100.0), i < 300 ? 0 : 1e-4 * (i - 300));
    step(w.model, w.state, scratch, inputs);
    ledger.add(w.model, w.state, scratch);
    held -= f_last.dot(inputs[0].p_WF - x_last);
    f_last = scratch.fingers[0].f_user_W;
    x_last = inputs[0].p_WF;
    if (i != 299) continue;
    const EnergyAccount& squeezed = ledger.account(0);
    // the spring's, but for the held force's delay
    EXPECT_NEAR(squeezed.held, 0.5 * 1000 * 2e-3 * 2e-3, 0.05 * squeezed.held);
    EXPECT_LT(std::abs(squeezed.numerical), 0.1 * squeezed.held);  // implicit in the tick: 1st order
  }
  const EnergyAccount& a = ledger.account(0);
  EXPECT_NEAR(a.held, held, 1e-12);
  EXPECT_NEAR(a.held, a.late + a.stored + a.damped + a.slipped + a.to_bodies + a.numerical, 1e-12);
  EXPECT_GT(a.damped, 0);
}

// The ball is dragged from under a finger that holds still: friction takes mu f_n times the way.
TEST(EnergyLedger, FrictionTakesForceTimesWay) {
  engine::WorldBuilder builder{engine::WorldOptions{}};
  builder.addBody({"table", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  GraspModel model = buildGrasp(builder, {tests::softFinger("finger")});
  GraspState state = makeState(model, {tests::startAt(Vec3::Zero())}, {Vec3(0, 0, 0.008)});
  GraspScratch scratch(model);
  std::vector<FingerInput> input(1);
  const auto lead = [&](const Vec3& p) {
    input[0].v_WF = (p - input[0].p_WF) / kTick;
    input[0].p_WF = p;
    step(model, state, scratch, input);
  };
  input[0].p_WF = Vec3(0, 0, 0.008);
  for (int i = 0; i < 100; ++i) lead(Vec3(0, 0, 0.007));
  for (int i = 0; i < 100; ++i) lead(Vec3(1e-4 * i, 0, 0.007));
  EnergyLedger ledger(model, state);
  const double start = state.world.points[0].p_W.x();
  double work = 0;
  for (int i = 0; i < 200; ++i) {
    lead(Vec3(0.01 + 1e-4 * i, 0, 0.007));
    ledger.add(model, state, scratch);
  }
  work = scratch.fingers[0].tangential_force * (state.world.points[0].p_W.x() - start);
  EXPECT_NEAR(ledger.account(0).slipped, work, 1e-9 * work + 1e-12);
  EXPECT_NEAR(work, 0.5 * 1.0 * 0.02, 1e-4);  // 1 N, 20 mm
}

TEST(Passivity, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  PassivityState state(2);
  const PassivityOptions options = controlling();
  std::vector<Vec3> p(2, Vec3::Zero()), f(2, Vec3(1, 0, 0));
  const auto before = tests::allocationCount();
  for (int i = 0; i < 100; ++i) {
    p[0].x() += 1e-4;
    observePorts(options, p, 0, kTick, state);
    controlPorts(options, kTick, state, f);
    holdPorts(f, state);
  }
  EXPECT_EQ(tests::allocationCount(), before);
}

}  // namespace
}  // namespace pincer::grasp
