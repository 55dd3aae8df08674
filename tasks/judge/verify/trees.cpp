// Trees of joints that move freely or on drives. Each answer is a closed form or an integration of equations that share
// no code with the engine (tasks/judge/exact/linkages.h):
//
//   rods       three hinged rods swing; their error falls by 2^4 when the tick is halved
//   elliptic   a pendulum whose pivot slides: momentum, and the angle
//   drive      where k e is the load it rests; a step of the target against exp(A t)
//   gear       q_2 = n q_1: I_1 + n^2 I_2
//   top        on a ball joint, against the equations of the heavy symmetric top
#include "pincer/tasks/judge/exact/linkages.h"
#include "pincer/tasks/judge/exact/rigid_body.h"
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;

// Of the chain of rods.
constexpr double kRod = 0.2, kRodMass = 0.1;

// Rods that hang at these angles; their joints are numbered as they are.
Linkage rodsAt(const std::vector<double>& angles, double h) {
  Linkage world(h);
  Vec3 end = Vec3::Zero();
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Quat q = quatFromRotationVector({0, angles[i], 0});
    engine::BodySpec rod{"rod" + std::to_string(i), contact::Capsule{0.002, 0.4 * kRod}, true, kRodMass, {}};
    const double across = kRodMass * kRod * kRod / 12;
    rod.inertia = engine::GivenInertia{Vec3::Zero(), Vec3(across, across, 1e-6).asDiagonal()};
    const int body = world.body(rod, {Pose{q, end - q * Vec3(0, 0, kRod / 2)}});
    const Vec3 on_parent = i == 0 ? Vec3::Zero() : Vec3(0, 0, -kRod / 2);
    engine::JointModel joint =
        jointAlong(JointKind::kPivot, Vec3::UnitY(), body, {0, 0, kRod / 2}, i == 0 ? -1 : body - 1, on_parent);
    joint.traits.start = i == 0 ? angles[i] : angles[i] - angles[i - 1];
    world.joint(joint);
    for (int other = 0; other < body - 1; ++other) world.exclude(other, body);  // they swing through each other
    end -= q * Vec3(0, 0, kRod);
  }
  world.build();
  return world;
}

double rodsError(double h, MeasureContext& context) {
  constexpr double kSeconds = 10;  // [s]
  const std::vector<double> start(3, 0.2);
  Linkage world = rodsAt(start, h);
  for (int second = 0; second < kSeconds; ++second) {
    world.run(1);
    context.progress((second + 1) / kSeconds);
  }
  const std::vector<double> exact = exact::RodChain{3, kRod, kRodMass, kVerifyG}.angles(start, kSeconds);
  double angle = 0, worst = 0;
  for (int i = 0; i < 3; ++i) {
    angle += world.position(i);
    worst = std::max(worst, std::abs(angle - exact[static_cast<std::size_t>(i)]));
  }
  return worst;
}

std::vector<Record> rods(MeasureContext& context) {
  const double coarse = rodsError(1e-3, context), fine = rodsError(5e-4, context);
  return {atMost("angle after 10 s, error", coarse, "rad", 1e-6),
          atLeast("at 1 ms over 0.5 ms, errors", coarse / fine, "-", 14)};
}

std::vector<Record> doublePendulum(MeasureContext& context) {
  Linkage world = rodsAt({2.5, -1}, 1e-3);
  const double start = world.energy();
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    world.run(0.1);
    worst = std::max(worst, std::abs(world.energy() - start));
    context.progress(n / 100.0);
  }
  const double whole = 2 * kRodMass * kVerifyG * 2 * kRod;  // from hanging to standing
  return {atMost("energy in 10 s of large swings, drift over m g l", worst / whole, "-", 1e-7)};
}

// A disk on a stick whose tip a ball joint holds, started `ratio` times as fast round the vertical as slow precession
// is. The joint's armature makes it a tree.
double topError(double spin, double ratio, double h, MeasureContext& context) {
  // Of the top: mass [kg], tip to centre [m], inertias [kg m^2], tilt [rad]. The exact top has the armature too.
  constexpr double kMass = 0.1, kLever = 0.04, kAcross = 6e-4, kAlong = 1e-3, kArmature = 1e-6,
                   kAngle = std::numbers::pi / 6;
  const exact::HeavyTop top{kMass, kLever,  kAcross + kMass * kLever * kLever + kArmature, kAlong + kArmature,
                            spin,  kVerifyG};
  const Quat q = quatFromRotationVector({0, kAngle, 0});
  const Vec3 axis = q * Vec3::UnitZ();
  const double heading_rate = ratio * top.slowPrecession(kAngle);
  const Vec3 w_W = Vec3(0, 0, heading_rate) + (spin - heading_rate * axis.z()) * axis;
  Linkage world(h);
  engine::BodySpec disk{"disk", contact::Sphere{0.001}, true, kMass, {}};
  disk.inertia = engine::GivenInertia{Vec3::Zero(), Vec3(kAcross, kAcross, kAlong).asDiagonal()};
  const int body = world.body(disk, {Pose{q, kLever * axis}, w_W.cross(kLever * axis), w_W});
  engine::JointModel ball = jointAlong(JointKind::kBall, Vec3::UnitZ(), body, {0, 0, -kLever}, -1, Vec3::Zero());
  ball.traits.armature = kArmature;
  world.joint(ball);
  world.build();
  double worst = 0;
  for (int n = 1; n <= 100; ++n) {
    world.run(0.1);
    worst = std::max(
        worst,
        (world.state().bodies[0].X_WI.q * Vec3::UnitZ() - top.axisAfter(world.time(), kAngle, heading_rate)).norm());
    context.progress(n / 100.0);
  }
  return worst;
}

std::vector<Record> top(MeasureContext& context) {
  const double coarse = topError(20, 1, 1e-3, context), swings = topError(20, 0, 1e-3, context);
  return {
      atMost("axis over 10 s of steady precession at 20 rad/s, error", coarse, "rad", 1e-6),
      atMost("axis over 10 s, let go at rest, error", swings, "rad", 1e-6),
      atLeast("at 10 ms over 5 ms, errors", topError(20, 0, 1e-2, context) / topError(20, 0, 5e-3, context), "-", 12)};
}

std::vector<Record> ellipticPendulum(MeasureContext&) {
  // Masses [kg], inertia [kg m^2], bob below block [m], first angle [rad], time [s]; chosen.
  constexpr double kBlock = 0.5, kBob = 0.2, kInertia = 1e-4, kDistance = 0.25, kStart = 1, kSeconds = 10;
  Linkage world;
  const int block = world.ball(kBlock, 1e-4, Vec3::Zero());
  engine::BodySpec bob{"bob", contact::Sphere{0.001}, true, kBob, {}};
  bob.inertia = engine::GivenInertia{Vec3::Zero(), kInertia * Mat3::Identity()};
  const Quat q = quatFromRotationVector({0, kStart, 0});
  const int hung = world.body(bob, {Pose{q, q * Vec3(0, 0, -kDistance)}});
  const int slide = world.joint(jointAlong(JointKind::kSlider, Vec3::UnitX(), block, Vec3::Zero(), -1, Vec3::Zero()));
  engine::JointModel pivot = jointAlong(JointKind::kPivot, Vec3::UnitY(), hung, {0, 0, kDistance}, block, Vec3::Zero());
  pivot.traits.start = kStart;
  const int turn = world.joint(pivot);
  world.build();
  double momentum = 0;
  for (int n = 0; n < 10; ++n) {
    world.run(kSeconds / 10);
    const auto& bodies = world.state().bodies;
    momentum = std::max(momentum, std::abs(kBlock * bodies[0].v_W.x() + kBob * bodies[1].v_W.x()));
  }
  const exact::EllipticPendulum exact{kBlock, kBob, kInertia, kDistance, kVerifyG};
  const double angle = exact.angle(kStart, kSeconds);
  // The bob hangs at -sin(angle): the block goes the other way.
  return {atMost("momentum along the rail, over that of the bob at its lowest",
                 momentum / (kBob * std::sqrt(2 * kVerifyG * kDistance)), "-", 1e-10),
          atMost("angle after 10 s, error", std::abs(world.position(turn) - angle), "rad", 1e-6),
          atMost("way of the block, error", std::abs(world.position(slide) + exact.way(kStart, angle)), "m", 1e-7),
          unflagged(world)};
}

// A slider of 1 kg on a drive that pulls to `target`, under its weight or not.
Linkage driven(double k, double d, double target, bool falls) {
  Linkage world(1e-3, falls ? Vec3(0, 0, -kVerifyG) : Vec3::Zero());
  const int body = world.ball(1, 1e-3, Vec3::Zero());
  engine::DriveModel drive =
      motorOn(world.joint(jointAlong(JointKind::kSlider, Vec3::UnitZ(), body, Vec3::Zero(), -1, Vec3::Zero())));
  drive.control = engine::DriveModel::Control::kPosition;
  drive.stiffness = k;
  drive.damping = d;
  world.drive(drive);
  world.build();
  world.controls[0].value = target;
  return world;
}

double stepError(double k, double d) {
  constexpr double kStep = 0.01;  // of the target [m or rad]; errors are told as a share of it
  Linkage world = driven(k, d, kStep, false);
  const exact::DampedOscillator oscillator{1, k, d};
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    world.tick();
    worst = std::max(worst, std::abs(world.position(0) - kStep - oscillator.place(-kStep, 0, world.time())));
  }
  return worst / kStep;
}

std::vector<Record> drives(MeasureContext&) {
  double sag = 0;
  for (const double k : {100.0, 1e4, 1e6}) {
    Linkage world = driven(k, std::sqrt(k), 0, true);
    world.run(30);
    sag = std::max(sag, std::abs(k * -world.position(0) - kVerifyG));
  }
  return {atMost("k e at rest less the load", sag, "N", 1e-9),
          atMost("step of a soft drive, error", stepError(1e4, 60), "-", 2e-4),
          atMost("step of a stiff drive that is damped, error: half a tick late", stepError(1e6, 1e5), "-", 1e-2)};
}

// Two wheels on parallel axes, the second geared to go -2.5 times as fast.
std::vector<Record> gear(MeasureContext&) {
  // Torque [N m], inertias of the wheels [kg m^2], rate of the second over the first [-]; chosen.
  constexpr double kTorque = 0.3, kFirst = 2e-3, kSecond = 5e-4, kRatio = -2.5;
  Linkage world;
  const int a = world.ball(0.2, kFirst, Vec3::Zero()), b = world.ball(0.1, kSecond, {0.1, 0, 0});
  const int first = world.joint(jointAlong(JointKind::kPivot, Vec3::UnitY(), a, Vec3::Zero(), -1, Vec3::Zero()));
  const int second = world.joint(jointAlong(JointKind::kPivot, Vec3::UnitY(), b, Vec3::Zero(), -1, {0.1, 0, 0}));
  world.couple({second, first, {0, kRatio, 0, 0, 0}});
  world.drive(motorOn(first));
  world.build();
  world.controls[0].value = kTorque;
  world.run(1);
  const double rate = kTorque / (kFirst + kRatio * kRatio * kSecond);
  return {atMost("rate after 1 s over that of I_1 + n^2 I_2, less 1", std::abs(world.velocity(first) / rate - 1), "-",
                 1e-12),
          atMost("ratio of the two angles, error",
                 std::abs(world.position(second) / world.position(first) / kRatio - 1), "-", 1e-12),
          unflagged(world)};
}

}  // namespace

std::vector<Measurement> verifyTrees() {
  return {{"tree/rods", rods},    {"tree/double-pendulum", doublePendulum},
          {"tree/top", top},      {"tree/elliptic-pendulum", ellipticPendulum},
          {"tree/drive", drives}, {"tree/gear", gear}};
}

}  // namespace pincer::tasks
