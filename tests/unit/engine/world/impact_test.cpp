// Impacts inside the tick: restitution, friction, the end of bouncing, tunnelling, energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/contact/polytope.h"
#include "pincer/engine/step.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::kGravity;
using tests::startAt;

constexpr double kBallRadius = 0.02;

// A ball of 0.1 kg over a floor.
struct Bouncing {
  WorldModel model;
  WorldState state;
  WorldScratch scratch;

  Bouncing(double restitution, double mu, const BodyStart& start, double g = kGravity)
      : Bouncing(build(restitution, mu, g), start) {}
  BodyState& ball() { return state.bodies[1]; }
  StepReport tick() { return step(model, state, scratch); }

 private:
  Bouncing(const WorldModel& m, const BodyStart& start)
      : model(m), state(makeState(model, {startAt(Vec3::Zero()), start}, {})), scratch(model) {}
  static WorldModel build(double restitution, double mu, double g) {
    WorldOptions options;
    options.gravity_W = Vec3(0, 0, -g);
    WorldBuilder builder(options);
    const Material material{mu, mu, restitution, 0};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
    builder.addBody({"ball", contact::Sphere{kBallRadius}, true, 0.1, material});
    return builder.build();
  }
};

TEST(Impact, PeaksFallByTheSquareOfTheRestitution) {
  Bouncing world(0.8, 0.2, startAt(Vec3(0, 0, 0.52)));
  int peaks = 0;
  double v_before = -1;
  for (int i = 0; i < 3000 && peaks < 5; ++i) {
    ASSERT_EQ(world.tick().status, kStepOk);
    const double v = world.ball().v_W.z();
    if (v_before > 0 && v <= 0) {
      const double peak = world.ball().X_WI.p.z() - kBallRadius + v * v / (2 * kGravity);
      // The hit is found to 1e-14 m of a fall of 50 mm or more; a thousand ticks of round-off are below that.
      EXPECT_NEAR(peak / (0.5 * std::pow(0.8, 2 * ++peaks)), 1, 1e-11);
    }
    v_before = v;
  }
  EXPECT_EQ(peaks, 5);
}

TEST(Impact, RestsWhenZenosBouncesAreOver) {
  for (double e : {0.5, 0.8, 0.95}) {
    Bouncing world(e, 0, startAt(Vec3(0, 0, kBallRadius + 0.1)));
    const double end = std::sqrt(2 * 0.1 / kGravity) * (1 + e) / (1 - e);
    // Bounces after a hit are cut off once they are shorter than a tick, or their flights than a sixteenth
    // of one: then 1/16 /(1 - e) ticks are left.
    const double early = 1e-3 * (2 + 1 / (16 * (1 - e)));
    while (world.state.time < end - early) world.tick();
    EXPECT_GT(world.ball().v_W.norm(), 0) << e;
    while (world.state.time < end + 2e-3) world.tick();
    EXPECT_LT(world.ball().v_W.norm(), 1e-10) << e;  // the solver's tolerance
    EXPECT_NEAR(world.ball().X_WI.p.z(), kBallRadius, 1e-12) << e;
  }
}

TEST(Impact, SuperballKeepsItsEnergyForAMinute) {
  Bouncing world(1, 0, startAt(Vec3(0, 0, 0.52)));
  const double start = kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state);
  double worst = 0;
  for (int i = 0; i < 60000; ++i) {
    world.tick();
    worst = std::max(
        worst, std::abs(kineticEnergy(world.model, world.state) + potentialEnergy(world.model, world.state) - start));
  }
  EXPECT_LT(worst, 1e-12 * start);
}

// Without gravity and spin, a sphere that hits at (v_t, -v_n) leaves with 5/7 v_t if friction can
// stop the contact within the hit, that is mu (1 + e) v_n >= 2/7 v_t; else with v_t - mu (1 + e)
// v_n. It spins with 5/2 of the loss over r.
TEST(Impact, FrictionActsWithinTheHit) {
  for (double v_t : {0.3, 3.0}) {
    const double mu = 0.3, e = 0.6, v_n = 1;
    Bouncing world(e, mu, startAt(Vec3(0, 0, 0.0203), Vec3(v_t, 0, -v_n)), 0);
    world.tick();
    const double loss = std::min(2.0 / 7 * v_t, mu * (1 + e) * v_n);
    EXPECT_NEAR(world.ball().v_W.z(), e * v_n, 1e-9);
    EXPECT_NEAR(world.ball().v_W.x(), v_t - loss, 1e-9);  // the solver's tolerance, 1e-10 of the speed
    EXPECT_NEAR(bodyAngularVelocity(world.model, world.state, 1).y(), 2.5 * loss / kBallRadius, 1e-6);
    EXPECT_NEAR(world.ball().X_WI.p.z(), kBallRadius + e * (1e-3 - 0.0003), 1e-9);  // it hit after 0.3 ms
  }
}

TEST(Impact, BallsSwapTheirSpeeds) {
  WorldOptions options;
  options.gravity_W.setZero();
  WorldBuilder builder(options);
  for (const char* name : {"cue", "eight"}) builder.addBody({name, contact::Sphere{0.02}, true, 0.17, {0, 0, 1, 0}});
  const WorldModel model = builder.build();
  WorldState state = makeState(model, {startAt(Vec3::Zero(), Vec3(1.7, 0, 0)), startAt(Vec3(0.0605, 0, 0))}, {});
  WorldScratch scratch(model);
  for (int i = 0; i < 100; ++i) step(model, state, scratch);
  EXPECT_NEAR(state.bodies[0].v_W.x(), 0, 1e-9);
  EXPECT_NEAR(state.bodies[1].v_W.x(), 1.7, 1e-9);
  EXPECT_NEAR(state.bodies[0].X_WI.p.x(), 0.0205, 1e-9);            // where it hit
  EXPECT_NEAR(state.bodies[1].X_WI.p.x(), 0.04 + 1.7 * 0.1, 1e-9);  // as if nothing but the names had changed
}

// 10 m/s are 10 mm per tick; the ball has 5 mm, the plate 1 mm. Every phase of the tick.
// Five balls of 10 mm in a row without friction, `apart` [m], the first of which comes at 1 m/s.
std::vector<double> speedsOfCradle(double apart) {
  constexpr double kRadius = 0.01;
  WorldOptions options;
  options.gravity_W.setZero();
  WorldBuilder builder(options);
  std::vector<BodyStart> starts;
  for (int i = 0; i < 5; ++i) {
    builder.addBody({"ball", contact::Sphere{kRadius}, true, 0.1, Material{0, 0, 1, 0}});
    starts.push_back(startAt(Vec3(i == 0 ? -kRadius : i * (2 * kRadius + apart), 0, 0)));
  }
  starts.front().v_W = Vec3(1, 0, 0);
  const WorldModel model = builder.build();
  WorldState state = makeState(model, starts, {});
  WorldScratch scratch(model);
  for (int n = 0; n < 100; ++n) EXPECT_EQ(step(model, state, scratch).status, kStepOk);
  std::vector<double> speeds;
  for (const BodyState& body : state.bodies) speeds.push_back(body.v_W.x());
  return speeds;
}

// By sequential impacts, as equal balls swap their speeds.
TEST(Impact, OfACradleWithGapsPassesFromBallToBall) {
  for (const double apart : {1e-6, 1e-5, 1e-4}) {
    const std::vector<double> speeds = speedsOfCradle(apart);
    for (std::size_t i = 0; i < speeds.size(); ++i)
      EXPECT_NEAR(speeds[i], i + 1 == speeds.size() ? 1 : 0, 1e-9) << apart << ", " << i;
  }
}

// Newton's law at all contacts at once: docs/accuracy.md tells it. Of n equal balls the first keeps 1 - 2 (n - 1) / n.
TEST(Impact, OfACradleThatTouchesIsOneHit) {
  const std::vector<double> speeds = speedsOfCradle(0);
  EXPECT_NEAR(speeds[0], -0.6, 1e-9);
  for (std::size_t i = 1; i < speeds.size(); ++i) EXPECT_NEAR(speeds[i], 0.4, 1e-9) << i;
}

TEST(Impact, FastBallDoesNotTunnelThroughAPlate) {
  for (bool plate_is_free : {false, true}) {
    for (int phase = 0; phase < 20; ++phase) {
      WorldOptions options;
      options.gravity_W.setZero();
      WorldBuilder builder(options);
      builder.addBody(
          {"plate", contact::Box{Vec3(0.05, 0.05, 0.0005)}, plate_is_free, plate_is_free ? 0.02 : 0, {0.3, 0.3, 0, 0}});
      builder.addBody({"ball", contact::Sphere{0.0025}, true, 5e-4, {0.3, 0.3, 0, 0}});
      const WorldModel model = builder.build();
      const double height = 0.03 + 0.0005 * phase;
      WorldState state =
          makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0.003, 0.002, height), Vec3(0.5, 0, -10))}, {});
      WorldScratch scratch(model);
      for (int i = 0; i < 20; ++i) {
        step(model, state, scratch);
        const Vec3 p = bodyPose(model, state, 0).inverse() * state.bodies[1].X_WI.p;
        EXPECT_GT(p.z(), 0.003 - 1e-6) << "free " << plate_is_free << ", phase " << phase << ", tick " << i;
      }
      const double momentum = 5e-4 * state.bodies[1].v_W.z() + 0.02 * state.bodies[0].v_W.z();
      if (plate_is_free) {
        EXPECT_NEAR(momentum, -5e-3, 1e-15);
      }
    }
  }
}

// Boxes and capsules thrown at random: no hit, no friction, no landing brings energy in.
// A ball at rest before a plate that is driven on at `v`, which Newton's law of impact sends off at (1 + e) v. Its
// restitution was taken for energy out of nothing and lowered to none.
TEST(Impact, OfADrivenRacketBounces) {
  for (const double e : {0.0, 0.3, 0.8, 1.0}) {
    for (const Vec3& v : {Vec3(0, 0, 0.5), Vec3(0, 0, 8), Vec3(0, 0.6, 2)}) {
      WorldOptions options;
      options.gravity_W.setZero();
      WorldBuilder builder(options);
      builder.addBody({"ball", contact::Sphere{kBallRadius}, true, 0.1, {0, 0, e, 0}});
      builder.addBody({"racket", contact::Box{Vec3(0.2, 0.2, 0.01)}, false, 0, {0, 0, e, 0}, true});
      const WorldModel model = builder.build();
      const auto racketAt = [&](double t) { return Vec3(t * v - Vec3(0, 0, 0.0316)); };
      WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt(racketAt(0), v)}, {});
      WorldScratch scratch(model);
      for (int i = 1; i <= 20; ++i) {
        const MotionInput racket{{Quat::Identity(), racketAt(1e-3 * i)}, {v, Vec3::Zero()}};
        EXPECT_EQ(step(model, state, scratch, StepInputs{{}, {&racket, 1}}).status, kStepOk);
      }
      EXPECT_NEAR(state.bodies[0].v_W.z(), (1 + e) * v.z(), 1e-12 * v.z()) << e;
    }
  }
}

TEST(Impact, ThrownBodiesNeverGainEnergy) {
  tests::RandomNumbers random(5);
  for (int n = 0; n < 40; ++n) {
    WorldBuilder builder{WorldOptions{}};
    const Material material{random.uniform(0, 1.5), 0, random.uniform(0, 1), 0};
    builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
    const contact::Shape box = contact::Box{Vec3(0.03, 0.02, 0.005)}, capsule = contact::Capsule{0.005, 0.04};
    builder.addBody({"thing", n % 2 ? box : capsule, true, 0.1, material});
    const WorldModel model = builder.build();
    const auto vector = [&](double size) {
      return Vec3{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
    };
    WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, 0.1), vector(1), vector(30))}, {});
    WorldScratch scratch(model);
    double lowest = kineticEnergy(model, state) + potentialEnergy(model, state);
    for (int i = 0; i < 500; ++i) {
      step(model, state, scratch);
      const double now = kineticEnergy(model, state) + potentialEnergy(model, state);
      // An edge that rolls over sinks by up to L (w h)^2 / 8 = 30 um, and a
      // correction lifts it again: m g 30 um = 3e-5 J.
      ASSERT_LE(now, lowest + 3e-5) << "case " << n << ", tick " << i;
      lowest = std::min(lowest, now);
    }
  }
}

// It slides fast after the hit, so it is swept, and the gap's parabola touches 0 just where
// it begins: it once sank freely from there.
TEST(Impact, ABallThatLandsObliquelyInALongTickSlidesOnTheFloor) {
  constexpr double kSmall = 0.0039;
  WorldOptions options;
  options.h = 8.6e-3;
  WorldBuilder builder(options);
  const Material material{2.9, 2.9, 0, 0};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, material});
  builder.addBody({"ball", contact::Sphere{kSmall}, true, 0.19, material});
  const WorldModel model = builder.build();
  for (int phase = 0; phase < 20; ++phase) {
    const double height = kSmall + 1e-3 + 4e-4 * phase;
    WorldState state = makeState(
        model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, height), Vec3(0.3, -0.46, -0.9), Vec3(-2, -3, 2))}, {});
    WorldScratch scratch(model);
    for (int i = 0; i < 30; ++i) {
      ASSERT_EQ(step(model, state, scratch).status, kStepOk);
      // The other contacts leave 1e-7 m of the root.
      ASSERT_GT(state.bodies[1].X_WI.p.z(), kSmall - 1e-7) << "phase " << phase << ", tick " << i;
    }
  }
}

// Housner's block of half width 0.03 and half height 0.09, let go at 0.15 rad: the tilt that it reaches on its other
// edge. Between impacts (2 R / (3 g)) w^2 + cos(alpha - th) is constant; the impact leaves 1 - 1.5 sin^2 alpha of w (G.
// W. Housner, Bull. Seismol. Soc. Am. 53 (1963)).
double rockingPeakError(double h) {
  constexpr double kTilt = 0.15, kB = 0.03, kH = 0.09;
  WorldOptions options;
  options.h = h;
  WorldBuilder builder(options);
  const Material rough{1, 1, 0, 0};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, rough});
  builder.addBody({"block", contact::Box{Vec3(kB, 0.03, kH)}, true, 0.5, rough});
  const WorldModel model = builder.build();
  const Quat q(Eigen::AngleAxisd(kTilt, Vec3::UnitY()));
  BodyStart start;
  start.X_WB = {q, -(q * Vec3(kB, 0, -kH))};
  WorldState state = makeState(model, {BodyStart{}, start}, {});
  WorldScratch scratch(model);
  double peak = 0;
  for (double tilt = kTilt; (peak < 0.01 || -tilt > peak - 0.01) && state.time < 2;) {
    EXPECT_EQ(step(model, state, scratch).status, kStepOk);
    const Quat now = state.bodies[1].X_WI.q;
    tilt = 2 * std::atan2(now.y(), now.w());
    peak = std::max(peak, -tilt);
  }
  const double alpha = std::atan2(kB, kH), kept = 1 - 1.5 * std::sin(alpha) * std::sin(alpha);
  const double top = std::cos(alpha) + kept * kept * (std::cos(alpha - kTilt) - std::cos(alpha));
  return std::abs(peak / (alpha - std::acos(top)) - 1);
}

TEST(Impact, RockingBlockLandsWithinTheTickToSecondOrder) {
  const double coarse = rockingPeakError(4e-3), fine = rockingPeakError(1e-3);
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 4e-3);
  EXPECT_LT(fine, 3e-4);
}

// A prism that came down on its corners cut the tick up to 16 times: what landed in a part that was cut short didn't
// count as one of its two landings.
TEST(Impact, APrismLandsAtMostTwiceInATick) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 16; ++i) {
    const double angle = 0.25 * tests::kPi * (i / 2);
    corners.emplace_back(0.02 * std::cos(angle), 0.02 * std::sin(angle), i % 2 ? 0.012 : -0.012);
  }
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"dish", contact::Dish{0.3}, false, 0, {0.5, 0.5}});
  builder.addBody({"prism", contact::Convex{contact::Polytope::hullOf(corners, "prism")}, true, 0.05, {0.5, 0.5}});
  const WorldModel model = builder.build();
  int most_parts = 0;
  for (int n = 1; n < 8; ++n) {
    const BodyStart prism{{quatFromRotationVector(Vec3(0.003 * n, 0.01 * n, 0.1 * n)), Vec3(0.001 * n, 0, 0.02)},
                          Vec3(0.01 * n, 0, -0.1),
                          Vec3(0.3 * (n % 5), 0.2 * (n % 3), n % 4)};
    WorldState state = makeState(model, {startAt(Vec3::Zero()), prism}, {});
    WorldScratch scratch(model);
    for (int tick = 0; tick < 80; ++tick) most_parts = std::max(most_parts, step(model, state, scratch).parts);
  }
  EXPECT_EQ(most_parts, 3);
}

TEST(Impact, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "a sanitizer owns the allocator";
  Bouncing world(0.9, 0.3, startAt(Vec3(0, 0, 0.03), Vec3(1, 0, 0), Vec3(0, 50, 20)));
  int cut = 0;
  const auto before = tests::allocationCount();
  for (int i = 0; i < 500; ++i) cut += world.tick().parts > 1;
  EXPECT_EQ(tests::allocationCount(), before);
  EXPECT_GT(cut, 3);
}

TEST(Impact, RestoredSnapshotGivesTheSameBits) {
  Bouncing world(0.9, 0.3, startAt(Vec3(0, 0, 0.03), Vec3(1, 0, 0), Vec3(0, 50, 20)));
  for (int i = 0; i < 40; ++i) world.tick();
  WorldState again = world.state;
  for (int i = 0; i < 200; ++i) world.tick();
  WorldScratch fresh(world.model);
  for (int i = 0; i < 200; ++i) step(world.model, again, fresh);
  EXPECT_EQ(hashOf(again), hashOf(world.state));
}

}  // namespace
}  // namespace pincer::engine
