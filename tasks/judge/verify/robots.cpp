// Trees as robots are: free flight, a jaw on a linkage.
//
//   flight         two hinged bodies on which nothing acts: both momenta; energy to 2nd order in the tick
//   linkage-grip   a jaw on four bars with a spring between two of them presses on a sprung plate: virtual work
#include <fmt/format.h>

#include "pincer/tasks/judge/exact/linkages.h"
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;

// --- Flight

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // about the origin
};
Momenta momentaOf(const Linkage& world, const std::vector<double>& masses) {
  Momenta sum;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const engine::BodyState& body = world.state().bodies[i];
    sum.linear += masses[i] * body.v_W;
    sum.angular += body.L_W + body.X_WI.p.cross(masses[i] * body.v_W);
  }
  return sum;
}

struct Drift {
  double linear = 0, angular = 0, energy = 0;  // over themselves
  int flagged = 0;
};

Drift driftOf(double h, double seconds, MeasureContext& context) {
  // Of the two bodies: masses [kg], moments [kg m^2], from their centres to the hinge [m]; of the first: rate [rad/s];
  // of the second past it [rad/s]; chosen.
  const std::vector<double> masses = {0.3, 0.12};
  const Vec3 moments[] = {{3e-4, 5e-4, 4e-4}, {8e-5, 6e-5, 1.1e-4}}, to_hinge(0.05, 0.01, 0), from_hinge(0.04, 0, 0.01);
  const Vec3 spin(2, -1, 3), axis = Vec3(1, 2, 2) / 3, second_spin = spin + 5 * axis;
  const engine::BodyStart starts[] = {
      {Pose{}, Vec3::Zero(), spin},
      {{Quat::Identity(), to_hinge + from_hinge}, spin.cross(to_hinge) + second_spin.cross(from_hinge), second_spin}};
  Linkage world(h, Vec3::Zero());
  for (std::size_t i = 0; i < 2; ++i) {
    engine::BodySpec spec{fmt::format("body{}", i), contact::Sphere{0.001}, true, masses[i], {}};
    spec.inertia = engine::GivenInertia{Vec3::Zero(), moments[i].asDiagonal()};
    world.body(spec, starts[i]);
  }
  world.joint(jointAlong(JointKind::kPivot, axis, 1, -from_hinge, 0, to_hinge));
  world.build();
  const Momenta start = momentaOf(world, masses);
  const double energy = world.energy();
  Drift drift;
  for (int second = 0; second < seconds; ++second) {
    world.run(1);
    const Momenta now = momentaOf(world, masses);
    drift.linear = std::max(drift.linear, (now.linear - start.linear).norm() / start.linear.norm());
    drift.angular = std::max(drift.angular, (now.angular - start.angular).norm() / start.angular.norm());
    drift.energy = std::max(drift.energy, std::abs(world.energy() / energy - 1));
    context.progress((second + 1) / seconds);
  }
  drift.flagged = world.flagged;
  return drift;
}

// Impulses of joints act at one point of both bodies, and what moving these onto the joint turns is given back: both
// momenta are kept but for round-off, which 60,000 ticks of some ulps add up to some 1e-12.
std::vector<Record> flight(MeasureContext& context) {
  const Drift whole = driftOf(1e-3, 60, context), coarse = driftOf(2e-3, 10, context),
              fine = driftOf(1e-3, 10, context);
  return {atMost("momentum in 60 s, drift over itself", whole.linear, "-", 1e-12),
          atMost("angular momentum in 60 s, drift over itself", whole.angular, "-", 1e-11),
          atMost("energy in 60 s, drift over itself", whole.energy, "-", 4e-5),
          atLeast("energy at 2 ms over 1 ms, drifts", coarse.energy / fine.energy, "-", 3.5),
          exactly("flagged ticks", whole.flagged, "-", 0)};
}

// --- A jaw on four bars

constexpr exact::FourBar kJaw{0.06, 0.2, 0.15, 0.18, 2e-4, 4e-4, 0.05, 3e-4};
constexpr double kTip = 0.005;                                             // radius at the rocker's end [m]
constexpr double kPlateSpring = 200, kLinkSpring = 0.05, kLinkRest = 0.1;  // [N/m], [N m/rad], [rad]

Vec3 alongBar(double length, double angle) { return length * Vec3(math::cos(angle), math::sin(angle), 0); }

// Of the crank's angle: the coupler's angle and its slope, the slope of the tip's way along x.
struct JawShape {
  double coupler, coupler_slope, tip_slope;
};
JawShape shapeAt(double a) {
  const double b = kJaw.rockerAngle(a), c_b = kJaw.ratio(a);
  const Vec3 bar = Vec3(kJaw.ground, 0, 0) + alongBar(kJaw.rocker, b) - alongBar(kJaw.crank, a);
  const Vec3 across(-bar.y(), bar.x(), 0);
  const Vec3 moved =
      c_b * alongBar(kJaw.rocker, b + std::numbers::pi / 2) - alongBar(kJaw.crank, a + std::numbers::pi / 2);
  return {math::atan2(bar.y(), bar.x()), across.dot(moved) / across.squaredNorm(), -c_b * kJaw.rocker * math::sin(b)};
}

engine::JointModel hingeAt(int a, const Vec3& p_A, int b, const Vec3& p_B) {
  return jointAlong(JointKind::kPivot, Vec3::UnitZ(), a, p_A, b, p_B);
}

struct Jaw {
  Linkage world{1e-3, Vec3::Zero()};
  int crank = 0, rocker = 0, coupler = 0;  // bodies
  int turn = 0, slide = 0;                 // joints of crank and plate
  Vec3 tip_W = Vec3::Zero();
};

// The four bars at this angle, a ball at the rocker's end, a motor at the crank.
void addBars(double start, Jaw& jaw) {
  const Vec3 A = alongBar(kJaw.crank, start), O(kJaw.ground, 0, 0),
             B = O + alongBar(kJaw.rocker, kJaw.rockerAngle(start)), middle = 0.5 * (A + B);
  jaw.tip_W = B;
  jaw.crank = jaw.world.ball(0.1, kJaw.crank_inertia, Vec3::Zero());
  engine::BodySpec bar{"rocker", {}, true, 0.1, {}};
  bar.shapes = {{.name = "tip", .shape = contact::Sphere{kTip}, .X_BS = {Quat::Identity(), B - O}}};
  bar.inertia = engine::GivenInertia{Vec3::Zero(), kJaw.rocker_inertia * Mat3::Identity()};
  jaw.rocker = jaw.world.body(bar, {Pose{Quat::Identity(), O}});
  jaw.coupler = jaw.world.ball(kJaw.coupler_mass, kJaw.coupler_inertia, middle);
  jaw.world.exclude(jaw.crank, jaw.rocker);
  jaw.turn = jaw.world.joint(hingeAt(jaw.crank, Vec3::Zero(), -1, Vec3::Zero()));
  jaw.world.joint(hingeAt(jaw.rocker, Vec3::Zero(), -1, O));
  engine::JointModel sprung = hingeAt(jaw.coupler, A - middle, jaw.crank, A);
  sprung.traits.stiffness = kLinkSpring;
  sprung.traits.rest = kLinkRest;
  jaw.world.joint(sprung);
  jaw.world.joint(hingeAt(jaw.coupler, B - middle, jaw.rocker, B - O));
  engine::DriveModel motor = motorOn(jaw.turn);
  motor.damping = 0.05;
  jaw.world.drive(motor);
}

// A plate on a sprung rail along x, on the side that the tip goes to.
void addPlate(double side, Jaw& jaw) {
  constexpr double kHalf = 0.01, kGap = 1e-4;  // of the plate, before it [m]
  const engine::BodySpec plate{"plate", contact::Box{Vec3(kHalf, 0.2, 0.02)}, true, 0.2, {.mu_s = 0, .mu_d = 0}};
  const Vec3 at = jaw.tip_W + Vec3(side * (kTip + kHalf + kGap), 0, 0);
  const int pressed = jaw.world.body(plate, {Pose{Quat::Identity(), at}});
  for (const int other : {jaw.crank, jaw.coupler}) jaw.world.exclude(other, pressed);
  engine::JointModel rail = jointAlong(JointKind::kSlider, Vec3::UnitX(), pressed, Vec3::Zero(), -1, at);
  rail.traits.stiffness = kPlateSpring;
  rail.damping = 5;
  jaw.slide = jaw.world.joint(rail);
}

// Imbalance of virtual work at rest, as a force at the plate [N].
double jawImbalance(double start, double torque) {
  Jaw jaw;
  const JawShape before = shapeAt(start);
  addBars(start, jaw);
  addPlate(torque * before.tip_slope > 0 ? 1 : -1, jaw);
  jaw.world.build();
  jaw.world.controls[0].value = torque;
  jaw.world.run(30);
  const double turned = jaw.world.position(jaw.turn), pressed = jaw.world.position(jaw.slide);
  const JawShape now = shapeAt(start + turned);
  const double link = now.coupler - before.coupler - turned;
  const double work =
      torque - kLinkSpring * (link - kLinkRest) * (now.coupler_slope - 1) - kPlateSpring * pressed * now.tip_slope;
  constexpr double kPressed = 1e-3;  // at least, or the tip went past [m]
  return jaw.world.flagged > 0 || std::abs(pressed) < kPressed ? std::nan("") : std::abs(work / now.tip_slope);
}

std::vector<Record> linkageGrip(MeasureContext& context) {
  double worst = 0;
  int done = 0;
  constexpr std::pair<double, double> kCases[] = {{0.4, -0.3}, {0.7, 0.1}, {0.7, 0.4}, {1.2, 0.1},
                                                  {1.2, 0.4},  {2.5, 0.1}, {2.5, -0.3}};
  for (const auto& [start, torque] : kCases) {
    const double one = jawImbalance(start, torque);
    worst = std::isnan(one) ? one : std::max(worst, one);
    context.progress(++done / static_cast<double>(std::size(kCases)));
  }
  return {atMost("force of the jaw less that of virtual work, springs included", worst, "N", 1e-9)};
}

}  // namespace

std::vector<Measurement> verifyRobots() { return {{"tree/flight", flight}, {"tree/linkage-grip", linkageGrip}}; }

}  // namespace pincer::tasks
