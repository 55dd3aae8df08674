// Linkages that close: their joints hold to round-off, and they move and rest as mechanisms of one
// freedom do (tasks/judge/exact/linkages.h).
//
//   four-bar       a crank that turns for 60 s: Freudenstein's equation, energy; where it is after 10 s; a load on
//                  the rocker that a drive at the crank holds
//   slider-crank   where it is after 10 s; the slider's place of the crank's angle
#include "pincer/tasks/judge/exact/linkages.h"
#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;

constexpr double kStart = 0.7, kRate = 12, kSeconds = 10;  // of the crank [rad, rad/s, s]
// The four bars, and the slider crank: lengths [m], masses [kg], inertias [kg m^2] in the order of linkages.h; chosen.
constexpr exact::FourBar kBars{0.06, 0.2, 0.15, 0.18, 2e-4, 4e-4, 0.05, 3e-4};
constexpr exact::SliderCrank kEngine{0.05, 0.16, 2e-4, 0.04, 2e-4, 0.1};

Vec3 at(double length, double angle) { return length * Vec3(math::cos(angle), math::sin(angle), 0); }
engine::JointModel pivotAt(int a, const Vec3& p_A, int b, const Vec3& p_B) {
  return jointAlong(JointKind::kPivot, Vec3::UnitZ(), a, p_A, b, p_B);
}

struct Mechanism {
  Linkage world;
  int crank = 0, out = 0;  // joints: of the crank, and of the rocker or slider
};

// All turned by nothing at the start: each body's angle is that of its way from there.
Mechanism fourBar(double h, double start) {
  Mechanism m{Linkage(h, Vec3::Zero())};
  const double b = kBars.rockerAngle(start);
  const Vec3 A = at(kBars.crank, start), O(kBars.ground, 0, 0), B = O + at(kBars.rocker, b);
  const int crank = m.world.ball(0.1, kBars.crank_inertia, Vec3::Zero()),
            rocker = m.world.ball(0.1, kBars.rocker_inertia, O),
            coupler = m.world.ball(kBars.coupler_mass, kBars.coupler_inertia, 0.5 * (A + B));
  m.world.exclude(crank, rocker);  // what nothing can touch goes to 4th order
  m.crank = m.world.joint(pivotAt(crank, Vec3::Zero(), -1, Vec3::Zero()));
  m.out = m.world.joint(pivotAt(rocker, Vec3::Zero(), -1, O));
  m.world.joint(pivotAt(coupler, 0.5 * (A - B), crank, A));
  m.world.joint(pivotAt(coupler, 0.5 * (B - A), rocker, B - O));
  return m;
}

Mechanism sliderCrank(double h, double start) {
  Mechanism m{Linkage(h, Vec3::Zero())};
  const Vec3 A = at(kEngine.crank, start), B(kEngine.place(start), 0, 0);
  const int crank = m.world.ball(0.1, kEngine.crank_inertia, Vec3::Zero()),
            slider = m.world.ball(kEngine.slider_mass, 1e-4, B),
            rod = m.world.ball(kEngine.rod_mass, kEngine.rod_inertia, 0.5 * (A + B));
  m.world.exclude(crank, slider);
  m.crank = m.world.joint(pivotAt(crank, Vec3::Zero(), -1, Vec3::Zero()));
  m.out = m.world.joint(jointAlong(JointKind::kSlider, Vec3::UnitX(), slider, Vec3::Zero(), -1, B));
  m.world.joint(pivotAt(rod, 0.5 * (A - B), crank, A));
  m.world.joint(pivotAt(rod, 0.5 * (B - A), slider, Vec3::Zero()));
  return m;
}

// Angle of the crank after kSeconds at kRate, less the exact one.
template <typename Exact>
double angleError(Mechanism m, const Exact& exact) {
  m.world.build();
  m.world.set(m.crank, 0, kRate);
  m.world.run(kSeconds);
  // The position is within half a turn.
  const double off = kStart + m.world.position(m.crank) - exact.angle(kStart, kRate, kSeconds);
  return std::abs(math::atan2(math::sin(off), math::cos(off)));
}

// A force that is 0: with it the linkage is a tree with a loop.
void addIdleMotor(Mechanism& m) { m.world.drive(motorOn(m.crank)); }

std::vector<Record> fourBars(MeasureContext& context) {
  Mechanism m = fourBar(1e-3, kStart);
  addIdleMotor(m);
  m.world.build();
  m.world.set(m.crank, 0, kRate);
  const double energy = m.world.energy(), b = kBars.rockerAngle(kStart);
  double miss = 0, drift = 0;
  for (int second = 0; second < 60; ++second) {
    m.world.run(1);
    miss = std::max(miss, std::abs(kBars.miss(kStart + m.world.position(m.crank), b + m.world.position(m.out))));
    drift = std::max(drift, std::abs(m.world.energy() / energy - 1));
    context.progress(second / 60.0);
  }
  const auto errorAt = [](double h) {
    Mechanism run = fourBar(h, kStart);
    addIdleMotor(run);
    return angleError(std::move(run), kBars);
  };
  const double coarse = errorAt(1e-3), fine = errorAt(5e-4);
  return {atMost("Freudenstein's equation through 60 s, miss", miss, "-", 1e-12),
          atMost("energy in 60 s, drift", drift, "-", 1e-6),
          atMost("angle of the crank after 10 s, error", coarse, "rad", 1e-5),
          atLeast("at 1 ms over 0.5 ms, errors", coarse / fine, "-", 8), unflagged(m.world)};
}

// A torque on the rocker, held by a spring of k = 20 N m/rad at the crank; virtual work: k e da + T db = 0.
std::vector<Record> loadedFourBar(MeasureContext&) {
  constexpr double kTorque = 0.5, kStiffness = 20;  // [N m], [N m/rad]
  double worst = 0;
  for (const double start : {0.3, 1.2, 2.5, 4.0}) {
    Mechanism m = fourBar(1e-3, start);
    engine::DriveModel hold = motorOn(m.crank), load = motorOn(m.out);
    hold.control = engine::DriveModel::Control::kPosition;
    hold.stiffness = kStiffness;
    hold.damping = 0.2;
    m.world.drive(hold);
    m.world.drive(load);
    m.world.build();
    m.world.controls[1].value = kTorque;
    m.world.run(20);
    const double a = m.world.position(m.crank);
    worst = std::max(worst, std::abs(-kStiffness * a + kTorque * kBars.ratio(start + a)));
  }
  return {atMost("torque at the crank less that of virtual work", worst, "N m", 1e-9)};
}

std::vector<Record> sliderCranks(MeasureContext&) {
  Mechanism m = sliderCrank(1e-3, kStart);
  addIdleMotor(m);
  m.world.build();
  m.world.set(m.crank, 0, kRate);
  double miss = 0;
  for (int n = 0; n < 100; ++n) {
    m.world.run(0.1);
    miss = std::max(miss, std::abs(kEngine.place(kStart + m.world.position(m.crank)) - kEngine.place(kStart) -
                                   m.world.position(m.out)));
  }
  Mechanism run = sliderCrank(1e-3, kStart);
  addIdleMotor(run);
  return {atMost("place of the slider, miss", miss, "m", 1e-13),
          atMost("angle of the crank after 10 s, error", angleError(std::move(run), kEngine), "rad", 1e-5),
          unflagged(m.world)};
}

}  // namespace

std::vector<Measurement> verifyLoops() {
  return {{"tree/four-bar", fourBars}, {"tree/four-bar-load", loadedFourBar}, {"tree/slider-crank", sliderCranks}};
}

}  // namespace pincer::tasks
