// Stops, brakes and limits of joints, and the loads that they hold. The answers are closed forms:
//
//   stop       s = F t^2/2m until the stop; e^2n of the height after n bounces; e = 0 rests at the stop to the bit
//   friction   holds at .999 of its limit, slides with (F - f)/m at 1.001; runs out after v^2 m/2f
//   limit      a drive gives its limit, and reaches its target
//   two-stops  two sliders, one on the other askew, get to their stops at once: each bounces by its own e
//   ticks      stop, dry friction and drive with ticks of 0.1 to 4 ms
//   pinch      s4_pinch by two sliders of 50 g that motors of 2 N push: the equations of s4_pinch
#include <array>

#include "pincer/contact/elementary.h"
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;

// A slider of 1 kg that a motor pushes to its stop 0.1 m ahead.
Linkage towardsStop(double force, double restitution, double h = 1e-3) {
  Linkage world(h, Vec3::Zero());
  engine::JointModel joint =
      jointAlong(JointKind::kSlider, Vec3::UnitX(), world.ball(1, 1e-3, Vec3::Zero()), Vec3::Zero(), -1, Vec3::Zero());
  joint.traits.upper = 0.1;
  joint.traits.restitution = restitution;
  world.drive(motorOn(world.joint(joint)));
  world.build();
  world.controls[0].value = force;
  return world;
}

std::vector<Record> stops(MeasureContext&) {
  constexpr double kForce = 2, kWay = 0.1, kRestitution = 0.5;  // [N], [m], [-]
  const double hit = std::sqrt(2 * kWay / kForce), speed = kForce * hit;
  Linkage bouncing = towardsStop(kForce, kRestitution);
  double time_error = std::nan(""), height_error = 0;
  // Between bounces v^2/2 + F (0.1 - q) stays F times the height of the parabola.
  double next = hit;
  int bounces = 0;
  while (bouncing.time() < 1.2 && bounces < 5) {
    bouncing.tick();
    if (bouncing.time() < next) continue;
    const double v = bouncing.velocity(0);
    if (bounces == 0) time_error = std::abs(bouncing.time() - (v + kRestitution * speed) / kForce - hit);
    ++bounces;
    const double height = v * v / (2 * kForce) + kWay - bouncing.position(0);
    height_error = std::max(height_error, std::abs(height / (kWay * math::pow(kRestitution, 2 * bounces)) - 1));
    next += 2 * hit * math::pow(kRestitution, bounces);
  }
  Linkage landing = towardsStop(kForce, 0);
  landing.run(1);
  const double rest = landing.position(0);
  landing.run(10);
  return {atMost("time of the hit, error", time_error, "s", 1e-12),
          atMost("height after 5 bounces, relative", height_error, "-", 1e-10),
          atMost("at rest beyond the stop", std::abs(rest - kWay), "m", 1e-12),
          exactly("moved in 10 s after that", landing.position(0) - rest, "m", 0),
          unflagged(bouncing),
          unflagged(landing)};
}

// A slider of 1 kg, and on it one of 0.5 kg that slides askew: M = (1.5, .5 c; .5 c, .5), c the cosine between the two.
// Constant forces give each its own constant acceleration, so that both stops are hit at the same moment; then each
// goes back by its own e, however the two pull at each other.
std::vector<Record> twoStops(MeasureContext&) {
  constexpr double kFirst = 1, kSecond = 0.5, kWay = 0.1, kCosine = 0.6;  // [kg], [kg], [m], [-]
  constexpr std::array<double, 2> kFaster{2, 3}, kRestitution{0.5, 0.8};  // accelerations [m/s^2]
  Linkage world(1e-3, Vec3::Zero());
  const int first = world.ball(kFirst, 1e-3, Vec3::Zero()), second = world.ball(kSecond, 1e-3, {0, 0, 0.1});
  const Vec3 askew(kCosine, std::sqrt(1 - kCosine * kCosine), 0);
  engine::JointModel outer = jointAlong(JointKind::kSlider, Vec3::UnitX(), first, Vec3::Zero(), -1, Vec3::Zero());
  engine::JointModel inner = jointAlong(JointKind::kSlider, askew, second, Vec3::Zero(), first, {0, 0, 0.1});
  outer.traits.upper = kWay;
  outer.traits.restitution = kRestitution[0];
  inner.traits.upper = kWay * kFaster[1] / kFaster[0];
  inner.traits.restitution = kRestitution[1];
  for (const engine::JointModel& joint : {outer, inner}) world.drive(motorOn(world.joint(joint)));
  world.build();
  const double tied = kSecond * kCosine;
  world.controls[0].value = (kFirst + kSecond) * kFaster[0] + tied * kFaster[1];
  world.controls[1].value = tied * kFaster[0] + kSecond * kFaster[1];
  const double hit = std::sqrt(2 * kWay / kFaster[0]);
  world.run(0.35);
  double worst = 0;
  for (int j = 0; j < 2; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double since = world.time() - hit, back = -kRestitution[i] * kFaster[i] * hit;
    const double limit = kWay * kFaster[i] / kFaster[0];
    worst = std::max(worst, std::abs(world.position(j) - limit - back * since - 0.5 * kFaster[i] * since * since));
    worst = std::max(worst, std::abs(world.velocity(j) - back - kFaster[i] * since));
  }
  world.run(8);
  const std::array<double, 2> rest{world.position(0), world.position(1)};
  world.run(2);
  return {atMost("places and speeds 34 ms after both are hit, error", worst, "m, m/s", 1e-10),
          atMost("at rest beyond the stops",
                 std::max(std::abs(rest[0] - kWay), std::abs(rest[1] - kWay * kFaster[1] / kFaster[0])), "m", 1e-10),
          exactly("moved in 2 s after that",
                  std::abs(world.position(0) - rest[0]) + std::abs(world.position(1) - rest[1]), "m", 0),
          unflagged(world)};
}

// A pendulum let go at the height of its pivot falls to its stop straight below: omega^2 = 2 m g
// d/I there, after a quarter of its period.
std::vector<Record> pendulumAndStop(MeasureContext&) {
  constexpr double kLever = 0.3, kMass = 0.4, kInertia = 1e-3, kRestitution = 0.8;  // [m], [kg], [kg m^2], [-]
  Linkage world;
  const int body = world.ball(kMass, kInertia, {kLever, 0, 0});
  engine::JointModel joint = jointAlong(JointKind::kPivot, Vec3::UnitY(), body, {-kLever, 0, 0}, -1, Vec3::Zero());
  joint.traits.upper = std::numbers::pi / 2;
  joint.traits.restitution = kRestitution;
  world.joint(joint);
  world.build();
  const double whole = kInertia + kMass * kLever * kLever, fall = 2 * kMass * kVerifyG * kLever / whole;
  double rebound = 0;
  for (int n = 0; n < 1000 && world.velocity(0) >= 0; ++n) world.tick();
  const double w = world.velocity(0), below = std::numbers::pi / 2 - world.position(0);
  rebound = w * w + fall * (1 - math::cos(below));
  // A joint with stops is of second order in the tick.
  return {atMost("energy after the stop over e^2 of that before, less 1",
                 std::abs(rebound / (kRestitution * kRestitution * fall) - 1), "-", 1e-4),
          unflagged(world)};
}

// A slider of 1 kg with dry friction of 3 N, pushed by `ratio` of it.
constexpr double kDry = 3;
Linkage dry(double ratio, double h = 1e-3) {
  Linkage world(h, Vec3::Zero());
  engine::JointModel joint =
      jointAlong(JointKind::kSlider, Vec3::UnitX(), world.ball(1, 1e-3, Vec3::Zero()), Vec3::Zero(), -1, Vec3::Zero());
  joint.traits.friction = kDry;
  world.drive(motorOn(world.joint(joint)));
  world.build();
  world.controls[0].value = ratio * kDry;
  return world;
}

std::vector<Record> dryFriction(MeasureContext& context) {
  Linkage held = dry(0.999), slides = dry(1.001), runs = dry(0);
  double moved = 0;
  for (int n = 0; n < 60; ++n) {
    held.run(1);
    moved = std::max(moved, std::abs(held.position(0)));
    context.progress(n / 120.0);
  }
  slides.run(1);
  const double exact = 0.5 * 0.001 * kDry;
  constexpr double kSpeed = 0.4;  // [m/s]
  runs.set(0, 0, kSpeed);
  runs.run(1);
  const double way = kSpeed * kSpeed / (2 * kDry);
  const double edge = threshold(0.9, 1.1, 34, [&](double ratio) {
    Linkage trial = dry(ratio);
    trial.run(1);
    return trial.position(0) > 1e-10;
  });
  return {atMost("moved in 60 s at .999 of the limit", moved, "m", 1e-15),
          atMost("way in 1 s at 1.001, relative error", std::abs(slides.position(0) / exact - 1), "-", 1e-9),
          atMost("push that just moves it over its friction, less 1", std::abs(edge - 1), "-", 1e-9),
          atMost("run-out, error over f h^2/8m", std::abs(runs.position(0) - way) / (kDry * 1e-6 / 8), "-", 1),
          unflagged(held),
          unflagged(slides),
          unflagged(runs)};
}

std::vector<Record> tickSizes(MeasureContext& context) {
  double time = 0, rest = 0, held = 0, slides = 0, flagged = 0;
  int done = 0;
  for (const double h : {1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 4e-3}) {
    constexpr double kForce = 2, kRestitution = 0.5;  // [N], [-]
    const double hit = std::sqrt(2 * 0.1 / kForce);
    Linkage bounces = towardsStop(kForce, kRestitution, h), lands = towardsStop(kForce, 0, h);
    bounces.run(0.4);
    time = std::max(time, std::abs(bounces.time() - (bounces.velocity(0) / kForce + kRestitution * hit) - hit));
    lands.run(1);
    rest = std::max(rest, std::abs(lands.position(0) - 0.1));
    Linkage still = dry(0.999, h), slow = dry(1.001, h);
    still.run(4);
    slow.run(1);
    held = std::max(held, std::abs(still.position(0)));
    slides = std::max(slides, std::abs(slow.position(0) / (0.5 * 0.001 * kDry) - 1));
    flagged += bounces.flagged + lands.flagged + still.flagged + slow.flagged;
    context.progress(++done / 6.0);
  }
  return {atMost("time of a hit, ticks of 0.1 to 4 ms, largest error", time, "s", 1e-12),
          atMost("at rest beyond the stop, likewise", rest, "m", 1e-12),
          atMost("moved in 4 s at .999 of dry friction, likewise", held, "m", 1e-15),
          atMost("way in 1 s at 1.001, likewise, relative error", slides, "-", 1e-9),
          exactly("flagged ticks", flagged, "-", 0)};
}

// A drive's force at its limit.
std::vector<Record> limitedDrive(MeasureContext&) {
  constexpr double kLimit = 4;  // force of the drive [N]
  Linkage world(1e-3, Vec3::Zero());
  engine::DriveModel drive = motorOn(world.joint(jointAlong(
      JointKind::kSlider, Vec3::UnitX(), world.ball(1, 1e-3, Vec3::Zero()), Vec3::Zero(), -1, Vec3::Zero())));
  drive.control = engine::DriveModel::Control::kPosition;
  drive.stiffness = 1e4;
  drive.damping = 200;
  drive.lower_force = -kLimit;
  drive.upper_force = kLimit;
  world.drive(drive);
  world.build();
  world.controls[0].value = 0.01;
  world.run(0.02);
  const double speed = world.velocity(0);
  world.run(10);
  return {atMost("speed after 20 ms at the limit over F t/m, less 1", std::abs(speed / (kLimit * 0.02) - 1), "-", 1e-9),
          atMost("at rest off the target", std::abs(world.position(0) - 0.01), "m", 1e-9), unflagged(world)};
}

// s4_pinch with its fingers made of balls on sliders.
Linkage pinchBySliders(double mu) {
  Linkage world;
  engine::BodySpec sphere{"sphere", contact::Sphere{0.02}, true, 0.1, {}};
  sphere.material.mu_s = sphere.material.mu_d = mu;
  world.body(sphere, {Pose{Quat::Identity(), {0, 0, 0.1}}});
  for (const double side : {-1.0, 1.0}) {
    engine::BodySpec tip{side < 0 ? "left" : "right", contact::Sphere{0.008}, true, 0.05, {}};
    tip.material = sphere.material;
    const Vec3 p(0.028 * side, 0, 0.1);
    const int body = world.body(tip, {Pose{Quat::Identity(), p}});
    world.drive(motorOn(world.joint(jointAlong(JointKind::kSlider, Vec3::UnitX(), body, Vec3::Zero(), -1, p))));
  }
  world.build();
  world.controls[0].value = 2;
  world.controls[1].value = -2;
  return world;
}

double apartFromFingers(std::string_view scene_name, int ticks) {
  Scene scene = readBuiltinScene(scene_name);
  Linkage world = pinchBySliders(scene.bodies[0].material.mu_s);
  Simulation sim(std::move(scene));
  double worst = 0;
  for (int n = 0; n < ticks; ++n) {
    sim.tick();
    world.tick();
    worst = std::max(worst, (sim.state().world.bodies[0].X_WI.p - world.state().bodies[0].X_WI.p).norm());
  }
  return world.flagged > 0 ? std::nan("") : worst;
}

std::vector<Record> pinch(MeasureContext&) {
  return {atMost("held, apart from s4_pinch in 10 s", apartFromFingers("s4_pinch", 10000), "m", 1e-12),
          atMost("slipping, apart from s4_pinch_098 in 0.3 s", apartFromFingers("s4_pinch_098", 300), "m", 1e-9)};
}

}  // namespace

std::vector<Measurement> verifyJointLimits() {
  return {{"tree/stop", stops},
          {"tree/two-stops", twoStops},
          {"tree/tick-sizes", tickSizes},
          {"tree/pendulum-stop", pendulumAndStop},
          {"tree/dry-friction", dryFriction},
          {"tree/limited-drive", limitedDrive},
          {"tree/pinch", pinch}};
}

}  // namespace pincer::tasks
