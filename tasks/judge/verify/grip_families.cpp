// Families of grips beside those of pads.cpp and pinches.cpp, each member judged alike; all of them with --long.
//
//   tips   every kind of fingertip, 5 to 40 mm wide: nudged, shaken by 5 mm at 5 Hz, turned by a quarter about each
//          axis; from a second later on the object stays where it is in the hand
//   rods   the angle d/(2 R) of a rod that pads roll by d, at radii, widths, speeds and headings
//   slip   a box between pads that shake it at .98 of the friction that would hold it: the point model of exact/pinch.h
//   objects  a box, a cylinder, a mug by its handle, six meshes between flat pads
//   many   n pinches in one world, their forces swinging by a tenth: each holds as it does alone
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "pincer/contact/functions/invariants.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/tasks/judge/exact/pinch.h"
#include "pincer/tasks/judge/verify/pad_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

struct Worst {
  double slip = 0, turn = 0, mesh_turn = 0, flagged = 0, runs = 0;  // [m], [rad]

  void note(const Pose& was, const Pose& is, bool is_mesh = false) {
    slip = std::max(slip, (is.p - was.p).norm());
    double& its = is_mesh ? mesh_turn : turn;
    its = std::max(its, angleBetween(was.q, is.q));
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

// Judged from `rest` seconds after the deed on.
void holdWhile(Deed deed, const PadGrip& grip, double rest, Worst& worst) {
  PadRun run(grip);
  HandMotion hand;
  if (deed != Deed::kNudged) {
    for (int i = 0; i < 500; ++i) run.tick(hand);
    const int ticks = deed == Deed::kShaken ? 2000 : 1000;
    for (int i = 1; i <= ticks; ++i) run.tick(hand = motionAt(deed, 1e-3 * i, 1e-3 * ticks));
    hand = {hand.q, hand.d};
  }
  for (const double end = run.time() + rest; run.time() < end;) run.tick(hand);
  const Pose was = run.inHand(hand.q);
  Standstill rests;
  for (const double end = run.time() + grip.seconds; run.time() < end && !rests.noted(run.state.world);) {
    run.tick(hand);
    worst.note(was, run.inHand(hand.q), std::holds_alternative<contact::Mesh>(grip.shape));
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
          holdWhile(static_cast<Deed>(deed), grip, 1, worst);
        }
      }
    }
  }
  const std::string time = context.thorough ? "in 60 s" : "in 1 s";
  std::vector<Record> records = worst.records(time);
  // Places on a smooth surface are found to 1e-12 m, and on a ball between flat pads the normals follow.
  constexpr double kMostOnMeshes = 1e-7;
  records.push_back(atMost("rotation of meshes " + time + ", the worst", worst.mesh_turn, "rad", kMostOnMeshes));
  return records;
}

// The scene's mug, held by its handle: 62 mm beside its centre of mass.
PadGrip mugGrip() {
  PadGrip grip{contact::Sphere{0.01}};
  grip.half = 0.004;
  grip.mass = 0.3;
  grip.mu = 0.8;
  grip.press = 60;
  grip.shapes = readBuiltinScene("mug").bodies[1].shapes;
  for (engine::ColliderSpec& part : grip.shapes) part.X_BS.p -= Vec3(0.067, 0, 0.05);
  return grip;
}

// Nudged, held for a minute with --long; meshes behind a patch_radius of 4 mm.
std::vector<Record> heldByPads(MeasureContext& context) {
  constexpr double kStill = 1e-6;  // [um]
  std::vector<std::pair<std::string, PadGrip>> grips = {{"box", {contact::Box{Vec3(0.015, 0.02, 0.025)}}},
                                                        {"cylinder", {contact::Cylinder{0.015, 0.03}}},
                                                        {"mug", mugGrip()}};
  for (const HeldMesh& held : heldMeshes()) {
    PadGrip grip{held.shape, 0.02};
    grip.patch_radius = 0.004;
    grips.emplace_back(held.name, grip);
  }
  std::vector<Record> records;
  double flagged = 0;
  for (auto& [name, grip] : grips) {
    Worst worst;
    for (const double width : {0.02, 0.03}) {
      grip.width = width;
      grip.w_W = Vec3(0.2, -0.1, 0.2);
      grip.seconds = context.thorough ? 60 : 1;
      holdWhile(Deed::kNudged, grip, 4, worst);
    }
    records.push_back(atMost("slip of a " + name, 1e6 * worst.slip, "um", kStill));
    flagged += worst.flagged;
  }
  records.push_back(exactly("flagged ticks", flagged, "-", 0));
  return records;
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

// The pads' targets go 20 mm to and fro at 5 Hz for 3 s, at `heading` from the horizontal in the pads' plane.
std::vector<Record> slipsShaken(double heading, MeasureContext&) {
  const Vec3 half(0.015, 0.02, 0.025);
  PadGrip grip{contact::Box{half}};
  grip.mass = 0.15;
  const double inertia = grip.mass / 3 * (half.y() * half.y() + half.z() * half.z());
  const Vec2 along(math::cos(heading), math::sin(heading));
  exact::ShakenGrip shaken{grip.mass, inertia, 0.05,    0.5 * grip.width - kRounding, 2000, 5, 10, 0, 0.02,
                           5,         along,   kVerifyG};
  shaken.mu = 0.98 * shaken.leastFriction(3);
  const std::vector<exact::ShakenGrip::Slip> exact = shaken.slips(3000, 1e-3);
  grip.mu = shaken.mu;
  grip.press = shaken.press;
  grip.stiffness = Vec3(0, shaken.stiffness, shaken.stiffness);
  PadRun run(grip);
  for (int i = 0; i < 500; ++i) run.tick();
  const Pose was = run.inHand(Quat::Identity());
  double off = 0, way = 0, turn = 0, turn_off = 0;
  for (int i = 1; i <= 3000; ++i) {
    const Vec2 d = shaken.target(1e-3 * i), v = shaken.targetSpeed(1e-3 * i);
    run.tick(Vec3(0, d.x(), d.y()), Vec3(0, v.x(), v.y()));
    const Pose now = run.inHand(Quat::Identity());
    const exact::ShakenGrip::Slip& right = exact[static_cast<std::size_t>(i - 1)];
    off = std::max(off, (Vec2(now.p.tail<2>() - was.p.tail<2>()) - right.way).norm());
    way = std::max(way, right.way.norm());
    turn = std::max(turn, std::abs(right.angle));
    const Vec3 about = right.angle * Vec3::UnitX();
    turn_off = std::max(turn_off, angleBetween(quatFromRotationVector(about) * was.q, now.q));
  }
  return {unbounded("slip on four corners", 1e6 * way, "um"), unbounded("turn on four corners", turn, "rad"),
          atMost("slip off that, over it", off / way, "-", 0.005), atMost("turn off that", turn_off, "rad", 1e-5),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// `n` boxes between flat pads, 200 mm apart.
class ManyGrips {
 public:
  explicit ManyGrips(int n) {
    const int side = static_cast<int>(std::ceil(std::sqrt(n)));
    engine::WorldBuilder builder{engine::WorldOptions{}};
    std::vector<engine::BodyStart> starts;
    std::vector<grasp::FingerModel> fingers;
    std::vector<Vec3> places;
    for (int i = 0; i < n; ++i) {
      const Vec3 at(0.2 * (i % side), 0.2 * (i / side), kUp);
      builder.addBody({fmt::format("box{}", i), contact::Box{Vec3(0.015, 0.02, 0.025)}, true, 0.1, {0.5, 0.5}});
      starts.push_back({{Quat::Identity(), at}, Vec3::Zero(), Vec3(0.2, -0.1, 0.2)});
      for (const double x : {-1.0, 1.0}) {
        grasp::FingerModel& f = fingers.emplace_back();
        f.name = fmt::format("{}{}", x < 0 ? "left" : "right", i);
        f.shape = flatPad(0.02);
        f.coupling.stiffness = Vec3(0, 2000, 2000);
        f.coupling.mass = 0.05;
        places.push_back(at + Vec3(x * (0.015 + kHalfThickness), 0, 0));
        inputs_.emplace_back().p_WF = places.back();
      }
    }
    model_ = grasp::buildGrasp(std::move(builder), fingers);
    state_ = grasp::makeState(model_, starts, places);
    scratch_ = grasp::makeScratch(model_);
  }

  void tick() {
    constexpr double kPress = 10, kSwing = 0.1, kRate = 6 * M_PI;  // [N], of it, [rad/s]
    const double time = 1e-3 * static_cast<double>(++ticks_);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const double swing = kSwing * math::sin(kRate * time + 0.1 * static_cast<double>(i / 2));
      inputs_[i].f_W.x() = (i % 2 == 0 ? 1 : -1) * kPress * (1 + swing);
    }
    flagged += grasp::step(model_, state_, *scratch_, inputs_).status != engine::kStepOk;
  }
  Pose inHand(std::size_t i) const {
    const auto& points = state_.world.points;
    const Pose& X = state_.world.bodies[i].X_WI;
    return {X.q, X.p - 0.5 * (points[2 * i].p_W + points[2 * i + 1].p_W)};
  }
  std::int64_t flagged = 0;

 private:
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  std::vector<grasp::FingerInput> inputs_;
  std::int64_t ticks_ = 0;
};

std::vector<Record> many(MeasureContext& context) {
  const int seconds = context.thorough ? 60 : 1;
  Worst worst;
  for (const int n : context.thorough ? std::vector<int>{1, 2, 17, 100, 300, 1000} : std::vector<int>{1, 17, 100}) {
    ManyGrips grips(n);
    std::vector<Pose> was;
    for (int i = 0; i < 1000; ++i) grips.tick();
    for (int i = 0; i < n; ++i) was.push_back(grips.inHand(static_cast<std::size_t>(i)));
    for (int tick = 0; tick < 1000 * seconds && !context.interrupted(); ++tick) {
      grips.tick();
      for (std::size_t i = 0; i < was.size(); ++i) worst.note(was[i], grips.inHand(i));
    }
    worst.flagged += static_cast<double>(grips.flagged);
    worst.runs += n;
  }
  return worst.records(fmt::format("in {} s", seconds));
}

}  // namespace

std::vector<Measurement> verifyGripFamilies() {
  return {{"pads/tips", tips},
          {"pads/objects", heldByPads},
          {"pads/roll-rods", rods},
          {"pads/slip-0.98-shaken", [](MeasureContext& c) { return slipsShaken(1, c); }},
          {"pads/slip-0.98-shaken-along", [](MeasureContext& c) { return slipsShaken(0.5 * M_PI, c); }},
          {"pads/slip-0.98-shaken-across", [](MeasureContext& c) { return slipsShaken(0, c); }},
          {"pads/many", many}};
}

}  // namespace pincer::tasks
