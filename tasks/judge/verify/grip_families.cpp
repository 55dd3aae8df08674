// Families of grips beside those of pads.cpp and pinches.cpp, each member judged alike; all of them with --long.
//
//   tips   every kind of fingertip, 5 to 40 mm wide: nudged, shaken by 5 mm at 5 Hz, turned by a quarter about each
//          axis; from a second later on the object stays where it is in the hand
//   rods   the angle d/(2 R) of a rod that pads roll by d, at radii, widths, speeds and headings
//   many   n pinches in one world, their forces swinging by a tenth: each holds as it does alone
#include <fmt/format.h>

#include "pincer/contact/generated_meshes.h"
#include "pincer/tasks/judge/verify/pad_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

struct Worst {
  double slip = 0, turn = 0, flagged = 0, runs = 0;  // [m], [rad]

  void note(const Pose& was, const Pose& is) {
    slip = std::max(slip, (is.p - was.p).norm());
    turn = std::max(turn, angleBetween(was.q, is.q));
  }
  std::vector<Record> records(const std::string& after) const {
    return {unbounded("grips", runs, "-"), atMost("slip " + after + ", the worst", 1e6 * slip, "um", 1e-6),
            atMost("rotation " + after + ", the worst", turn, "rad", 1e-9), exactly("flagged ticks", flagged, "-", 0)};
  }
};

struct Tip {
  contact::FingerShape shape;
  double reach;  // along x [m]
  bool is_flat;  // carries torsion by its corners
};
std::vector<Tip> tipsOf(double width) {
  const double r = 0.5 * width;
  return {{contact::Sphere{r}, r, false},
          {contact::CapsuleTip{0.4 * r, Vec3(0, 0, 0.6 * r)}, 0.4 * r, false},
          {contact::CapsuleTip{0.4 * r, Vec3(0, 0.6 * r, 0)}, 0.4 * r, false},
          {contact::CapsuleTip{0.4 * r, Vec3(0.6 * r, 0, 0)}, r, false},
          {contact::EllipsoidTip{Vec3(0.7 * r, 0.85 * r, r)}, 0.7 * r, false},
          {flatPad(width), kHalfThickness, true},
          {roundPad(width), kHalfThickness, true}};
}

struct Held {
  contact::Shape shape;
  double half = 0.015;    // along x [m]
  bool is_round = false;  // flat tips need a patch_radius, or it spins
};
std::vector<Held> heldObjects(bool all) {
  std::vector<Held> objects = {{contact::Box{Vec3(0.015, 0.02, 0.025)}},
                               {contact::Cylinder{0.015, 0.004}},
                               {smooth(contact::box(Vec3(0.015, 0.02, 0.025)))}};
  if (!all) return objects;
  for (const double half : {0.003, 0.03}) {
    objects.push_back({contact::Capsule{0.015, half}});
    objects.push_back({contact::Box{Vec3(0.015, half, 0.005)}});
  }
  objects.push_back({contact::Cylinder{0.015, 0.03}});
  objects.push_back({contact::Sphere{0.015}, 0.015, true});
  objects.push_back({smooth(contact::geodesicSphere(0.015, 8)), 0.015, true});
  objects.push_back({smooth(contact::cylinder(0.015, 0.02, 24, 1))});
  return objects;
}

enum class Deed { kNudged, kShaken, kTurnedX, kTurnedY, kTurnedZ };

// Of the hand at `t` seconds of `of` while it does that.
HandMotion motionAt(Deed deed, double t, double of) {
  const double x = t / of;
  HandMotion hand;
  if (deed == Deed::kShaken) {
    constexpr double kSwing = 0.005, kRate = 10 * M_PI;  // [m], [rad/s]
    const double s = math::sin(M_PI * x), grown = s * s, rate = 2 * M_PI / of * s * math::cos(M_PI * x);
    const Vec3 along = Vec3(0.3, 0.8, -0.52).normalized();
    hand.d = kSwing * grown * math::sin(kRate * t) * along;
    hand.v = kSwing * (grown * kRate * math::cos(kRate * t) + rate * math::sin(kRate * t)) * along;
    return hand;
  }
  const Vec3 axis = Vec3::Unit(static_cast<int>(deed) - static_cast<int>(Deed::kTurnedX));
  const double turned = 0.5 * M_PI * x * x * x * (10 - 15 * x + 6 * x * x);  // minimum jerk
  hand.q = quatFromRotationVector(turned * axis);
  hand.w = 0.5 * M_PI * 30 * x * x * (1 - x) * (1 - x) / of * axis;
  return hand;
}

void holdWhile(Deed deed, const PadGrip& grip, Worst& worst) {
  constexpr double kRest = 1;  // before it is judged [s]
  PadRun run(grip);
  HandMotion hand;
  if (deed != Deed::kNudged) {
    for (int i = 0; i < 500; ++i) run.tick(hand);
    const int ticks = deed == Deed::kShaken ? 2000 : 1000;
    for (int i = 1; i <= ticks; ++i) run.tick(hand = motionAt(deed, 1e-3 * i, 1e-3 * ticks));
    hand = {hand.q, hand.d};
  }
  for (const double end = run.time() + kRest; run.time() < end;) run.tick(hand);
  const Pose was = run.inHand(hand.q);
  for (const double end = run.time() + grip.seconds; run.time() < end;) {
    run.tick(hand);
    worst.note(was, run.inHand(hand.q));
  }
  worst.flagged += static_cast<double>(run.flagged);
  ++worst.runs;
}

std::vector<Record> tips(MeasureContext& context) {
  Worst worst;
  for (const Held& held : heldObjects(context.thorough)) {
    for (const double width : {0.005, 0.01, 0.02, 0.03, 0.04}) {
      for (const Tip& tip : tipsOf(width)) {
        for (int deed = 0; deed < 5 && !context.interrupted(); ++deed) {
          PadGrip grip{held.shape, held.half};
          grip.tip = tip.shape;
          grip.tip_reach = tip.reach;
          grip.patch_radius = tip.is_flat && !held.is_round ? 0 : 0.004;
          grip.w_W = Vec3(0.2, -0.1, 0.2);
          grip.seconds = context.thorough ? 60 : 1;
          holdWhile(static_cast<Deed>(deed), grip, worst);
        }
      }
    }
  }
  return worst.records(context.thorough ? "in 60 s" : "in 1 s");
}

// Angle against rolling without slip, the worst over `strokes` to and fro [rad].
double rollsOff(const PadGrip& grip, double heading, double hertz, int strokes, Worst& worst) {
  PadRun run(grip);
  for (int i = 0; i < 200; ++i) run.tick();
  const Vec3 along = grip.q_WB * Vec3::UnitY(), axis = grip.q_WB * Vec3::UnitZ();
  PINCER_ASSERT(angleBetween(along, Vec3(0, math::cos(heading), math::sin(heading))) < 1e-9);
  const int ticks = static_cast<int>(1000 / hertz + 0.5);
  const double swing = 0.125 * grip.width, rate = 2e3 * M_PI / ticks;
  double off = 0;
  for (int i = 1; i <= strokes * ticks; ++i) {
    const double phase = 2 * M_PI * i / ticks;
    run.tick(swing * (1 - math::cos(phase)) * along, swing * rate * math::sin(phase) * along, -1);
    const double d = (run.state.world.points[0].p_W - run.state.world.points[1].p_W).dot(along);
    const Quat turn = run.turned() * grip.q_WB.conjugate();
    const double angle = 2 * math::atan2(turn.vec().dot(axis), turn.w());
    off = std::max(off, std::abs(std::abs(angle) - std::abs(d) / (2 * grip.half)));
  }
  worst.flagged += static_cast<double>(run.flagged);
  ++worst.runs;
  return off;
}

std::vector<Record> rods(MeasureContext& context) {
  const int strokes = context.thorough ? 1000 : 2;
  Worst worst;
  double off = 0;
  for (const double radius : {0.002, 0.005, 0.01}) {
    for (const double width : {0.02, 0.04}) {
      for (const double hertz : {0.5, 2.0, 5.0}) {
        for (const double heading : {0.0, 0.3}) {
          for (int k = 0; k < 4 && !context.interrupted(); ++k) {
            PadGrip grip{k & 1 ? contact::Shape(contact::Capsule{radius, 0.02}) : contact::Cylinder{radius, 0.02}};
            grip.half = radius;
            grip.mass = 0.02;
            grip.mu = 0.8;
            grip.width = width;
            grip.press = 5;
            grip.stiffness = Vec3(0, 20000, 20000);
            grip.q_WB = quatFromRotationVector(heading * Vec3::UnitX());
            if (k & 2) grip.gravity_W.setZero();
            off = std::max(off, rollsOff(grip, heading, hertz, strokes, worst));
          }
        }
      }
    }
  }
  return {unbounded("rods", worst.runs, "-"),
          atMost(fmt::format("angle against rolling, the worst over {} strokes", strokes), 1e3 * off, "mrad",
                 1e-6 * strokes),
          exactly("flagged ticks", worst.flagged, "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyGripFamilies() { return {{"pads/tips", tips}, {"pads/roll-rods", rods}}; }

}  // namespace pincer::tasks
