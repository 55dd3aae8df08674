// Objects between two pads: held, shaken, let slip, spun, rolled, hung beside their centre. The closed forms:
//
//   stuck     the object moves as its pads do
//   tilt      a plate whose centre of mass is e beside the pads hangs at 2 k theta =
//             m g e cos theta on their turning springs
//   slip      mu = .98 m g/(2 N): falls with .02 g and doesn't turn
//   spin      four corners at radius r carry N/4 each: w' = -2 mu N r / I, about the pads' normal
//   rod       pads that move apart by d turn a rod of radius R between them by d/(2 R), without slip
#include <fmt/format.h>

#include <array>

#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/mesh/lathe.h"
#include "pincer/tasks/judge/verify/pad_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

const contact::Shape kBrick = contact::Box{Vec3(0.015, 0.02, 0.025)};  // half sides [m]

// Nudged at the start; judged from when the nudge has been taken up.
std::vector<Record> hold(const PadGrip& grip, MeasureContext& context) {
  PadRun run(grip);
  double slip = 0, turn = 0;
  while (run.time() < 1) run.tick();
  const Vec3 p = run.place() - run.padsPlace();
  const Quat q = run.turned();
  while (run.time() < grip.seconds && !context.interrupted()) {
    run.tick();
    slip = std::max(slip, (run.place() - run.padsPlace() - p).norm());
    turn = std::max(turn, angleBetween(q, run.turned()));
  }
  const std::string held = fmt::format("in {} s", grip.seconds);
  return {atMost("slip " + held, 1e6 * slip, "um", 1e-6), atMost("rotation " + held, turn, "rad", 1e-9),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

Measurement holdOf(const char* name, const contact::Shape& shape, double width) {
  PadGrip grip{.shape = shape, .width = width};
  grip.w_W = Vec3(0, 0.3, 0);
  return {name, [grip](MeasureContext& context) { return hold(grip, context); }};
}

// The pads reach over the object's edge by `over` of their width, along y and, at a corner, along z.
Measurement overhangOf(const char* name, double over, bool at_corner) {
  PadGrip grip{kBrick};
  grip.off.y() = 0.02 + (over - 0.5) * grip.width;
  if (at_corner) grip.off.z() = 0.025 + (over - 0.5) * grip.width;
  grip.seconds = 10;
  grip.w_W = Vec3(0, 0.3, 0);
  return {name, [grip](MeasureContext& context) { return hold(grip, context); }};
}

Measurement tipOf(const char* name, const contact::FingerShape& tip, double reach) {
  PadGrip grip{kBrick};
  grip.tip = tip;
  grip.tip_reach = reach;
  grip.patch_radius = 0.004;
  grip.w_W = Vec3(0, 0.3, 0);
  return {name, [grip](MeasureContext& context) { return hold(grip, context); }};
}

// How a solid lies between the pads.
struct Lie {
  contact::Shape shape;
  double half = 0.015;  // along x [m]
  double angle = 0;     // about `axis` [rad]
  Vec3 axis = Vec3::UnitX();
  double along = 0;  // its frame from the middle of its extent along x [m]
};

std::vector<Lie> lies() {
  constexpr double kQuarter = 0.5 * M_PI, kR = 0.015;  // turn [rad]; radius [m]
  std::vector<Lie> all;
  for (const double angle : {0.0, 0.4, kQuarter}) {
    for (const double half_length : {0.004, 0.03}) {
      all.push_back({contact::Cylinder{kR, half_length}, kR, angle});
      all.push_back({contact::CylinderWithFlat{kR, half_length, 0.012}, 0.0135, angle, Vec3::UnitX(), 0.0015});
      all.push_back({smooth(contact::cylinder(kR, half_length, 24, 1)), kR, angle});
    }
    all.push_back({contact::Capsule{kR, 0.01}, kR, angle});
    all.push_back({contact::Box{Vec3(kR, 0.02, 0.025)}, kR, angle});
  }
  all.push_back({contact::Cylinder{kR, 0.012}, 0.012, kQuarter, Vec3::UnitY()});
  for (const double flat : {0.005, 0.012})
    all.push_back({contact::CylinderWithFlat{kR, 0.012, flat}, kR, kQuarter, Vec3::UnitZ()});
  return all;
}

// Every lie between pads of every size, square and round, hard and soft, nudged about all axes: the worst of all.
std::vector<Record> sweeps(MeasureContext& context) {
  constexpr std::array<double, 5> kWidths = {0.005, 0.01, 0.02, 0.03, 0.04};  // [m]: under and over the objects
  double slip = 0, turn = 0, flagged = 0, grips = 0;
  for (const Lie& lie : lies()) {
    for (std::size_t k = 0; k < 4 * kWidths.size(); ++k, ++grips) {
      PadGrip grip{lie.shape, lie.half};
      grip.q_WB = quatFromRotationVector(lie.angle * lie.axis);
      grip.along = lie.along;
      grip.width = kWidths[k / 4];
      grip.patch_radius = k & 1 ? 0.004 : 0;
      if (k & 2) grip.tip = roundPad(grip.width);
      grip.w_W = Vec3(0.2, -0.1, 0.2);
      const std::vector<Record> held = hold(grip, context);
      slip = std::max(slip, held[0].value);
      turn = std::max(turn, held[1].value);
      flagged += held[2].value;
    }
  }
  return {unbounded("grips", grips, "-"), atMost("slip in 60 s, the worst", slip, "um", 1e-6),
          atMost("rotation in 60 s, the worst", turn, "rad", 1e-9), exactly("flagged ticks", flagged, "-", 0)};
}

// Meshes felt as the smooth solids that they stand for: flat faces, a straight wall.
Measurement meshOf(const char* name, const contact::TriangleMesh& mesh, double half, double width) {
  PadGrip grip{smooth(mesh)};
  grip.half = half;
  grip.width = width;
  grip.patch_radius = 0.004;
  grip.w_W = Vec3(0, 0.3, 0);
  return {name, [grip](MeasureContext& context) { return hold(grip, context); }};
}

// Profile of a solid of the half length `half`, of the radius `middle` there and of less by `bulge` at its ends [m].
std::vector<Vec2> bulging(double middle, double bulge, double half) {
  constexpr int kSteps = 12;  // of the profile, a parabola; chosen
  std::vector<Vec2> profile{{0, -half}};
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -1 + 2.0 * i / kSteps;
    profile.push_back({middle - bulge * z * z, half * z});
  }
  profile.push_back({0, half});
  return profile;
}

// Curved meshes that pads touch in a point or along a rim.
Measurement curvedOf(const char* name, const contact::TriangleMesh& mesh) {
  PadGrip grip{smooth(mesh)};
  grip.patch_radius = 0.004;
  grip.w_W = Vec3(0, 0.3, 0);
  return {name, [grip](MeasureContext& context) { return hold(grip, context); }};
}

// Friction carries five times its moment; hung until it stands. The lever is what the pads'
// sag and its own landing leave of `beside`.
std::vector<Record> hangs(MeasureContext&) {
  PadGrip grip{kBrick};
  grip.mass = 0.2;
  grip.mu = 1;
  grip.beside = 0.012;
  grip.stiffness = Vec3(0, 20000, 20000);
  grip.turn_stiffness = 0.2;
  PadRun run(grip);
  while (run.time() < 4) run.tick();
  constexpr double kHangs = 0.0587585;  // the root of 0.4 theta = 0.2 kg 9.81 m/s^2 0.012 m cos theta
  const Vec3& turn_W = run.state.world.points[0].turn_W;
  const double moment = grip.mass * kVerifyG * (run.place().y() - run.padsPlace().y());
  return {atMost("2 k theta over the weight's moment, less 1",
                 std::abs(2 * grip.turn_stiffness * turn_W.norm() / moment - 1), "-", 1e-9),
          atMost("theta off m g e cos theta/(2 k)", std::abs(turn_W.norm() / kHangs - 1), "-", 1e-3),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// The pads' targets go 20 mm to and fro at 5 Hz, their swing growing in the first second.
std::vector<Record> shake(const Vec3& along, MeasureContext&) {
  PadGrip grip{kBrick};
  grip.mass = 0.15;
  grip.mu = 2.5;
  grip.press = 10;
  grip.stiffness = Vec3(0, 2000, 2000);
  PadRun run(grip);
  double slip = 0, turn = 0;
  for (int i = 0; i < 500; ++i) run.tick();
  const Vec3 p = run.place() - run.padsPlace();
  const double w = 10 * M_PI;
  for (int i = 1; i <= 5000; ++i) {
    const double t = 1e-3 * i, swing = 0.02 * std::min(t, 1.0), rate = t < 1 ? 0.02 : 0;
    run.tick(swing * math::sin(w * t) * along, (swing * w * math::cos(w * t) + rate * math::sin(w * t)) * along);
    slip = std::max(slip, (run.place() - run.padsPlace() - p).norm());
    turn = std::max(turn, angleBetween(Quat::Identity(), run.turned()));
  }
  return {atMost("slip against the pads", 1e6 * slip, "um", 1e-6), atMost("rotation", turn, "rad", 1e-9),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Gravity lies in the pads' plane, at `heading` from -z.
std::vector<Record> slipsOut(double heading, MeasureContext&) {
  PadGrip grip{kBrick};
  const Vec3 down(0, math::sin(heading), -math::cos(heading));
  grip.gravity_W = kVerifyG * down;
  grip.press = 10;
  grip.mu = 0.98 * grip.mass * kVerifyG / (2 * grip.press);
  grip.stiffness.setZero();
  grip.locked = {false, true, true};
  PadRun run(grip);
  for (int i = 0; i < 300; ++i) run.tick();
  const double whole = 0.5 * 0.02 * kVerifyG * run.time() * run.time();
  return {atMost("way, error over the whole way", std::abs((run.place() - Vec3(0, 0, kUp)).dot(down) / whole - 1), "-",
                 1e-9),
          atMost("rotation", angleBetween(Quat::Identity(), run.turned()), "rad", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

std::vector<Record> spinsDown(MeasureContext&) {
  PadGrip grip{kBrick};
  grip.press = 2;
  grip.mu = 0.3;
  grip.stiffness.setZero();
  grip.locked = {false, true, true};
  grip.gravity_W.setZero();
  grip.w_W = Vec3(20, 0, 0);
  PadRun run(grip);
  const double inertia = grip.mass * (0.04 * 0.04 + 0.05 * 0.05) / 12,
               r = std::sqrt(2.0) * (0.5 * grip.width - kRounding);
  const double braking = 2 * grip.mu * grip.press * r / inertia, end = grip.w_W.x() / braking;
  while (run.time() < 0.5 * end) run.tick();
  const double w = engine::bodyAngularVelocity(run.model.world, run.state.world, 0).x();
  const double error = std::abs((grip.w_W.x() - w) / (braking * run.time()) - 1);
  while (run.time() < end + 0.02) run.tick();
  return {atMost("torque while it slips over 2 mu N r, less 1", error, "-", 1e-3),
          atMost("spin 20 ms after I w/(2 mu N r)",
                 engine::bodyAngularVelocity(run.model.world, run.state.world, 0).norm(), "rad/s", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// A thousand strokes of 10 mm to and fro of each pad, against each other.
std::vector<Record> rollsRod(MeasureContext&) {
  PadGrip grip{contact::Capsule{0.005, 0.02}};
  grip.half = 0.005;
  grip.mass = 0.02;
  grip.mu = 0.8;
  grip.width = 0.04;
  grip.press = 5;
  grip.stiffness = Vec3(0, 20000, 20000);
  grip.gravity_W.setZero();
  PadRun run(grip);
  for (int i = 0; i < 200; ++i) run.tick();
  constexpr int kStrokes = 1000, kTicks = 500;  // strokes; [ticks] of one: half a second
  double worst = 0;
  for (int i = 1; i <= kStrokes * kTicks; ++i) {
    const double phase = 2 * M_PI * i / kTicks, rate = 2 * M_PI / (kTicks * 1e-3);
    run.tick(Vec3(0, 0.005 * (1 - math::cos(phase)), 0), Vec3(0, 0.005 * rate * math::sin(phase), 0), -1);
    const double d = run.state.world.points[0].p_W.y() - run.state.world.points[1].p_W.y();
    const double angle = 2 * math::atan2(run.turned().z(), run.turned().w());
    worst = std::max(worst, std::abs(std::abs(angle) - std::abs(d) / (2 * grip.half)));
  }
  return {atMost("angle against rolling without slip, over 1000 strokes", 1e3 * worst, "mrad", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyPads() {
  return {holdOf("pads/hold-5mm", kBrick, 0.005),
          holdOf("pads/hold-10mm", kBrick, 0.01),
          holdOf("pads/hold-20mm", kBrick, 0.02),
          holdOf("pads/hold-40mm", kBrick, 0.04),
          holdOf("pads/hold-cylinder", contact::Cylinder{0.015, 0.03}, 0.02),
          holdOf("pads/hold-short-cylinder", contact::Cylinder{0.015, 0.004}, 0.02),
          holdOf("pads/hold-coin", contact::Cylinder{0.015, 0.002}, 0.01),
          holdOf("pads/hold-rod", contact::Capsule{0.015, 0.03}, 0.02),
          holdOf("pads/hold-short-rod", contact::Capsule{0.015, 0.005}, 0.02),
          overhangOf("pads/hold-edge", 0.6, false),
          overhangOf("pads/hold-corner", 0.6, true),
          tipOf("pads/tip-sphere", contact::Sphere{0.008}, 0.008),
          tipOf("pads/tip-capsule", contact::CapsuleTip{0.006, Vec3(0, 0, 0.008)}, 0.006),
          tipOf("pads/tip-ellipsoid", contact::EllipsoidTip{Vec3(0.006, 0.009, 0.008)}, 0.006),
          tipOf("pads/tip-round", roundPad(0.02), kHalfThickness),
          meshOf("pads/mesh-box", contact::gridBox(Vec3(0.015, 0.02, 0.025), 6), 0.015, 0.02),
          meshOf("pads/mesh-cylinder", contact::lathe({{0, -0.02}, {0.018, -0.02}, {0.018, 0.02}, {0, 0.02}}, 48),
                 0.018, 0.02),
          curvedOf("pads/mesh-ball", contact::geodesicSphere(0.015, 8)),
          curvedOf("pads/mesh-barrel", contact::lathe(bulging(0.015, 0.004, 0.02), 48)),
          curvedOf("pads/mesh-short-barrel", contact::lathe(bulging(0.015, 0.001, 0.006), 48)),
          curvedOf("pads/mesh-spool", contact::lathe(bulging(0.013, -0.002, 0.02), 48)),
          {"pads/sweep", sweeps},
          {"pads/tilt", hangs},
          {"pads/shake-across", [](MeasureContext& c) { return shake(Vec3::UnitY(), c); }},
          {"pads/shake-along", [](MeasureContext& c) { return shake(Vec3::UnitZ(), c); }},
          {"pads/slip-0.98", [](MeasureContext& c) { return slipsOut(0, c); }},
          {"pads/slip-0.98-askew", [](MeasureContext& c) { return slipsOut(0.3, c); }},
          {"pads/slip-0.98-diagonal", [](MeasureContext& c) { return slipsOut(0.25 * M_PI, c); }},
          {"pads/spin-down", spinsDown},
          {"pads/roll-rod", rollsRod}};
}

}  // namespace pincer::tasks
