// Jaws with a given motion that close further than what is between them allows: no velocity obeys both.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/worlds.h"

namespace pincer::engine {
namespace {

using tests::startAt;

constexpr double kHalf = 0.02, kMass = 0.1;  // of what is gripped [m, kg]

// Two driven plates that close along x at `speed`, from touching to `depth` each, and a body between them.
struct Jaws {
  double speed, depth;
  WorldModel model;
  WorldState state;
  WorldScratch scratch;
  int ticks = 0, flagged = 0;
  double largest_force = 0, largest_speed = 0;

  Jaws(const contact::Shape& shape, double closing_speed, double closing_depth, int threads = 1)
      : speed(closing_speed),
        depth(closing_depth),
        model(build(shape, threads)),
        state(makeState(
            model, {startAt(Vec3::Zero()), startAt(Vec3(-kHalf - 0.01, 0, 0)), startAt(Vec3(kHalf + 0.01, 0, 0))}, {})),
        scratch(model) {}

  // To where they have closed by `way`, at `rate` each.
  void tick(double way, double rate) {
    const MotionInput jaws[] = {
        {{Quat::Identity(), Vec3(-kHalf - 0.01 + way, 0, 0)}, {Vec3(rate, 0, 0), Vec3::Zero()}},
        {{Quat::Identity(), Vec3(kHalf + 0.01 - way, 0, 0)}, {Vec3(-rate, 0, 0), Vec3::Zero()}}};
    const StepReport report = step(model, state, scratch, StepInputs{{}, jaws});
    flagged += (report.status & kSolverNotConverged) != 0;
    for (const Contact& c : scratch.contacts)
      largest_force = std::max(largest_force, c.r[kNormalRow] / model.options.h);
    largest_speed = std::max(largest_speed, body().v_W.norm());
    ++ticks;
  }
  void close(int count) {
    for (int i = 0; i < count; ++i) {
      const double way = std::min(speed * 1e-3 * (ticks + 1), depth);
      tick(way, way < depth ? speed : 0);
    }
  }
  const BodyState& body() const { return state.bodies[0]; }

 private:
  static WorldModel build(const contact::Shape& shape, int threads) {
    WorldOptions options;
    options.threads = threads;
    WorldBuilder builder{options};
    const Material material{0.5, 0.5, 0, 0};
    builder.addBody({"gripped", shape, true, kMass, material});
    for (const char* name : {"left", "right"})
      builder.addBody({name, contact::Box{Vec3(0.01, 0.05, 0.05)}, false, 0, material, true});
    return builder.build();
  }
};

// A box was flung at 7.8 km/s, a ball shot out at 21 m/s, by 1e12 N and more, one tick of all
// flagged. Held by symmetry in the middle now: it sinks by what a tick without contacts falls (5 um),
// and what sticks is drawn back to where it stuck.
TEST(Jaws, DontFlingWhatTheyCloseOn) {
  for (const contact::Shape& shape :
       {contact::Shape(contact::Box{Vec3(kHalf, kHalf, kHalf)}), contact::Shape(contact::Sphere{kHalf})}) {
    for (const double speed : {1e-3, 0.01, 0.1, 1.0}) {
      Jaws jaws(shape, speed, 1e-3);
      jaws.close(1500);
      EXPECT_LE(jaws.largest_speed, 0.02) << speed;
      EXPECT_LE(jaws.body().X_WI.p.norm(), 2e-5) << speed;
      // a thousand times what stops a body that comes at the jaws' speed, or at 10 mm/s
      EXPECT_LE(jaws.largest_force, 1e3 * kMass * std::max(speed, 0.01) / 1e-3) << speed;
      EXPECT_GE(jaws.scratch.contacts.at(0).r[kNormalRow] / 1e-3, 1) << speed;
      EXPECT_GE(jaws.flagged, 1400 - static_cast<int>(1 / speed)) << speed;
    }
  }
}

// Opened again they let it go as it is: it falls, and no faster than that.
TEST(Jaws, LetGoOfWhatTheySqueezed) {
  Jaws jaws(contact::Box{Vec3(kHalf, kHalf, kHalf)}, 0.01, 1e-3);
  jaws.close(300);
  constexpr int kOpening = 300;
  const double z = jaws.body().X_WI.p.z();
  int falling = 0;
  for (int i = 1; i <= kOpening; ++i) {
    jaws.tick(1e-3 - 1e-5 * i, -0.01);
    falling += jaws.scratch.contacts.empty() || !jaws.scratch.contacts.at(0).active();
  }
  EXPECT_GE(falling, 150);
  EXPECT_LE(std::abs(jaws.body().v_W.x()), 1e-2);
  EXPECT_NEAR(jaws.body().v_W.z(), -tests::kGravity * 1e-3 * falling, 0.05);
  EXPECT_LT(jaws.body().X_WI.p.z(), z - 0.05);
}

// On a floor, under a plate: halfway into both.
TEST(Jaws, APlateComesDownOnABall) {
  WorldBuilder builder{WorldOptions{}};
  builder.addBody({"floor", contact::HalfSpace{}, false, 0, {0.5, 0.5, 0, 0}});
  builder.addBody({"ball", contact::Sphere{kHalf}, true, kMass, {0.5, 0.5, 0, 0}});
  builder.addBody({"plate", contact::Box{Vec3(0.05, 0.05, 0.01)}, false, 0, {0.5, 0.5, 0, 0}, true});
  const WorldModel model = builder.build();
  const auto plateAt = [](double way) { return Vec3(0, 0, 2 * kHalf + 0.01 - way); };
  WorldState state = makeState(model, {startAt(Vec3::Zero()), startAt(Vec3(0, 0, kHalf)), startAt(plateAt(0))}, {});
  WorldScratch scratch(model);
  for (int i = 1; i <= 200; ++i) {
    const MotionInput plate{{Quat::Identity(), plateAt(1e-5 * i)}, {Vec3(0, 0, -0.01), Vec3::Zero()}};
    step(model, state, scratch, StepInputs{{}, {&plate, 1}});
  }
  EXPECT_NEAR(state.bodies[1].X_WI.p.z(), kHalf - 1e-3, 5e-5);
  EXPECT_LE(state.bodies[1].v_W.norm(), 0.01);
}

// A capsule that leans on its hinge under a plate that comes down.
struct Prop {
  double mu = 0.6, heading = 0, lean = 0.15, speed = 1.5, tick = 2e-3;  // [-, rad, rad, m/s, s]
  bool has_stops = true;
  int ticks = 60;

  static constexpr double kLength = 0.1, kRadius = 0.01, kGap = 1.1e-3;  // [m]

  WorldModel build(const Quat& q) const {
    WorldOptions options;
    options.h = tick;
    WorldBuilder builder{options};
    builder.addBody({"prop", contact::Capsule{kRadius, 0.5 * kLength - kRadius}, true, kMass, {mu, mu, 0, 0}});
    builder.addBody({"plate", contact::Box{Vec3(0.2, 0.2, 0.01)}, false, 0, {mu, mu, 0, 0}, true});
    const Quat along_x = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX());
    JointModel hinge{JointKind::kPivot, 0, -1, {along_x, Vec3(0, 0, -0.5 * kLength)}, {q * along_x, Vec3::Zero()}};
    if (has_stops) {
      hinge.traits.lower = -1.2;
      hinge.traits.upper = 1.2;
    }
    builder.addJoint(hinge);
    return builder.build();
  }

  // How fast its tip ever is, as a share of the plate's speed; infinite if a number overflows.
  double fastestTip() const {
    const Quat q(quatFromRotationVector(heading * Vec3::UnitZ()) * quatFromRotationVector(lean * Vec3::UnitX()));
    const WorldModel model = build(q);
    const double top = (q * Vec3(0, 0, kLength - kRadius)).z() + kRadius + kGap;
    const auto plateAt = [&](double way) { return Vec3(0, 0, top + 0.01 - way); };
    WorldState state = makeState(
        model,
        {{{q, q * Vec3(0, 0, 0.5 * kLength)}, Vec3::Zero(), Vec3::Zero()}, startAt(plateAt(0), Vec3(0, 0, -speed))},
        {});
    WorldScratch scratch(model);
    double fastest = 0;
    for (int i = 1; i <= ticks; ++i) {
      const MotionInput plate{{Quat::Identity(), plateAt(speed * tick * i)}, {Vec3(0, 0, -speed), Vec3::Zero()}};
      const StepReport report = step(model, state, scratch, StepInputs{{}, {&plate, 1}});
      if (report.status & kStateNotFinite) return std::numeric_limits<double>::infinity();
      fastest = std::max(fastest, kLength * bodyAngularVelocity(model, state, 0).norm() / speed);
    }
    return fastest;
  }
};

// Friction jams it, and no velocity obeys both. It turned at 7e9 rad/s, and a robot's finger
// that stood so until a number overflowed.
TEST(Jaws, DontFlingAPropThatFrictionJams) {
  for (const double mu : {0.6, 0.7, 0.8, 1.0}) {
    for (const double heading : {0.0, 0.3}) {
      // impulses of more than 1e5 times what stops it are those of walls that close (squeeze.h)
      EXPECT_LE((Prop{.mu = mu, .heading = heading}).fastestTip(), 1e5) << mu << ' ' << heading;
    }
  }
}

// The plate hits it, and friction jams it in that hit: round-off made an impulse of it that turned the prop at 3e12 to
// 3e17 rad/s. Until the plate is half way down nothing asks for more than 25 times its own speed.
TEST(Jaws, DontFlingAPropThatAHitJams) {
  constexpr double kHalfWay = 0.045;  // [m]
  for (const double heading : {0.0, 0.3}) {
    for (const auto& [mu, lean, speed, tick] : {std::array{0.3, 0.3, 0.1, 1e-3},
                                                {0.3, 0.05, 1.5, 1e-3},
                                                {0.3, 0.15, 1.5, 2e-3},
                                                {0.6, 0.15, 1.5, 1e-3},
                                                {0.6, 0.05, 0.1, 1e-3}}) {
      const Prop prop{mu, heading, lean, speed, tick, false, static_cast<int>(kHalfWay / (speed * tick))};
      EXPECT_LE(prop.fastestTip(), 50) << mu << ' ' << heading << ' ' << lean << ' ' << speed << ' ' << tick;
    }
  }
}

// The plate comes down over the hinge and 40 mm past it: the arm that is left of its push vanishes on the way. The prop
// turned at up to 1e11 rad/s; sqrt(2 g/(h R)) with g the plate's speed and that of pushing out an overlap is 249 rad/s
// at 1.5 m/s, and a hit may give 10 g/R.
TEST(Jaws, APlateThatPassesAHingeSpinsNoProp) {
  constexpr double kWay = 0.15, kSpeedOut = 0.05;  // [m, m/s]
  for (const double mu : {0.0, 0.6, 1.0}) {
    for (const double lean : {0.05, 0.3, 0.6}) {
      for (const double speed : {0.1, 1.5}) {
        const Prop prop{mu, 0.3, lean, speed, 1e-3, false, static_cast<int>(kWay / (speed * 1e-3))};
        const double g = speed + kSpeedOut, reach = 0.5 * Prop::kLength;
        const double fastest = std::max(std::sqrt(2 * g / (prop.tick * reach)), 10 * g / reach);
        EXPECT_LE(prop.fastestTip(), 1.05 * fastest * Prop::kLength / speed) << mu << ' ' << lean << ' ' << speed;
      }
    }
  }
}

// A thin rod across a belt spins about itself at up to 300 rad/s, where sqrt(2 g/(h R)) is 122 with half its length as
// R: it was held back, and sank into the belt.
TEST(Jaws, ABeltRollsAThinRod) {
  constexpr double kRadius = 5e-3, kSpeed = 1.5, kTick = 1e-3;
  WorldBuilder builder(WorldOptions{});
  builder.addBody({"rod", contact::Capsule{kRadius, 0.195}, true, 0.1, {0.5, 0.5, 0, 0}});
  builder.addBody({"belt", contact::Box{Vec3(2, 1, 0.05)}, false, 0, {0.5, 0.5, 0, 0}, true});
  const WorldModel model = builder.build();
  const Quat lying(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
  const auto beltAt = [&](double t) { return Vec3(kSpeed * t, 0, -0.05); };
  WorldState state = makeState(
      model, {{{lying, Vec3(0, 0, kRadius)}, Vec3::Zero(), Vec3::Zero()}, startAt(beltAt(0), Vec3(kSpeed, 0, 0))}, {});
  WorldScratch scratch(model);
  for (int i = 1; i <= 400; ++i) {
    const MotionInput belt{{Quat::Identity(), beltAt(kTick * i)}, {Vec3(kSpeed, 0, 0), Vec3::Zero()}};
    step(model, state, scratch, StepInputs{{}, {&belt, 1}});
    ASSERT_NEAR(bodyPose(model, state, 0).p.z(), kRadius, 1e-4) << i;
  }
  // it rolls: its lowest point goes with the belt
  const Vec3 v_W = state.bodies[0].v_W, w_W = bodyAngularVelocity(model, state, 0);
  EXPECT_NEAR(v_W.x() - kRadius * w_W.y(), kSpeed, 1e-3);
  EXPECT_GT(std::abs(w_W.y()), 150);
}

TEST(Jaws, TheSameBitsOnTwoThreadsAndAgain) {
  const auto hashAfter = [](int threads) {
    Jaws jaws(contact::Box{Vec3(kHalf, kHalf, kHalf)}, 0.02, 1e-3, threads);
    jaws.close(200);
    return hashOf(jaws.state);
  };
  EXPECT_EQ(hashAfter(1), hashAfter(1));
  EXPECT_EQ(hashAfter(1), hashAfter(2));
}

// A palm that turns about z, with a jaw on either side, geared to each other and pressed on what hangs far beside them.
struct TurningPalm {
  static constexpr double kBeside = 0.06, kForce = 30, kTurn = 6;  // [m], [N] each, [rad/s^2]
  static constexpr double kJaw = 0.005;                            // half a jaw's thickness [m]
  WorldModel model = build();
  WorldState state = makeState(model,
                               {startAt(Vec3(0, kBeside, 0)), startAt(Vec3::Zero()), startAt(Vec3(-kHalf - kJaw, 0, 0)),
                                startAt(Vec3(kHalf + kJaw, 0, 0))},
                               {});
  WorldScratch scratch{model};
  double time = 0;
  std::uint32_t status = 0;

  static WorldModel build() {
    WorldBuilder builder{WorldOptions{}};
    const Material material{0.8, 0.8, 0, 0};
    builder.addBody({"rod", contact::Box{Vec3(kHalf, kBeside + 0.01, 0.01)}, true, 0.3, material});
    builder.addBody({"palm", contact::Sphere{0.001}, false, 0, material, true});
    builder.excludePair(0, 1);
    DriveModel drive;
    drive.name = "grip";
    drive.terms = {{addJaw(-1, material, builder), 1}};
    drive.control = DriveModel::Control::kForce;
    builder.addCoupling({addJaw(1, material, builder), drive.terms[0].joint});
    builder.addDrive(drive);
    return builder.build();
  }
  static int addJaw(double side, const Material& material, WorldBuilder& builder) {
    const std::string name = side < 0 ? "left" : "right";
    const int jaw = builder.addBody({name, contact::Box{Vec3(kJaw, 0.01, 0.02)}, true, 0.05, material});
    builder.excludePair(1, jaw);
    const Quat inwards(Eigen::AngleAxisd(-side * tests::kPi / 2, Vec3::UnitY()));
    JointModel slider{
        JointKind::kSlider, jaw, 1, {inwards, Vec3::Zero()}, {inwards, Vec3(side * (kHalf + kJaw), 0, 0)}, 0};
    slider.name = "slide_" + name;
    return builder.addJoint(slider);
  }
  // At rest for half a second, then it turns ever faster.
  void tick() {
    time += model.options.h;
    const double since = std::max(time - 0.5, 0.0);
    const Quat q(Eigen::AngleAxisd(0.5 * kTurn * since * since, Vec3::UnitZ()));
    const MotionInput palm[] = {{{q, Vec3::Zero()}, {Vec3::Zero(), Vec3(0, 0, kTurn * since)}}};
    const DriveInput grip[] = {{2 * kForce, 0, false}};
    status |= step(model, state, scratch, StepInputs{{}, palm, {}, grip}).status;
  }
  Pose inPalm() const { return bodyPose(model, state, 1).inverse() * bodyPose(model, state, 0); }
};

// The jaws' free motion was along the palm's axes at the end of a tick, contacts in its middle: the difference wrung
// friction until all of it slid, from the second tick on. Half a second later contacts contradicted each other by more
// than a chord at the contacts' speed does, for the thing's centre is faster: 152 um.
TEST(Jaws, OnAPalmThatTurnsHoldWhatHangsFarBesideThem) {
  TurningPalm grip;
  while (grip.time < 0.4) grip.tick();
  const Pose held = grip.inPalm();
  double slip = 0;
  while (grip.time < 1) {
    grip.tick();
    slip = std::max(slip, (grip.inPalm().p - held.p).norm());
  }
  constexpr double kFast = TurningPalm::kTurn * 0.5, kTick = 1e-3;
  EXPECT_LT(slip, kTick * kTick * kFast * kFast * TurningPalm::kBeside);  // it goes by chords
  EXPECT_EQ(grip.status, kStepOk);
}

}  // namespace
}  // namespace pincer::engine
