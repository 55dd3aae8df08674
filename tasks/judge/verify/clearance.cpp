// A slider-crank whose slider rattles in its guide, against its run by events (tasks/judge/exact/clearance.h), up to
// the third hit of the slider's corners.
//
// Corners of one pair that hit within two ticks of each other are one hit to the engine: the second lands (impact.h).
// Runs are compared until then; the slider that comes to the guide nearly flat chatters there.
#include "pincer/tasks/judge/exact/clearance.h"

#include "pincer/tasks/judge/verify/linkage.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

using engine::JointKind;
using exact::ClearanceCrank;

constexpr int kHits = 3;
constexpr double kRattleTick = 5e-5, kLongest = 0.012;  // [s]; the guide's other side is reached later
constexpr double kCrankRate = 150, kRodRate = -75;      // of the paper [rad/s]
constexpr double kFlat = 0, kTilting = -10;             // rates of the slider [rad/s]: both corners hit at once, or one
constexpr double kAlone = 2;                            // ticks between hits that are two to the engine

struct RattlingCrank {
  Linkage world;
  int crank = 0, rod = 0, slider = 0;  // joints

  Vec3 angles() const {
    const double a = world.position(crank), b = a + world.position(rod);
    return {a, b, b + world.position(slider)};
  }
};

void addGuide(const ClearanceCrank& m, const engine::Material& material, int crank, int rod, Linkage& world) {
  for (const double side : {-1.0, 1.0}) {
    const engine::BodySpec half{side < 0 ? "below" : "above", contact::HalfSpace{}, false, 0, material};
    const Pose X_W{Quat(frameFromNormal(Vec3(0, -side, 0))), {0, side * (m.half_height + m.clearance), 0}};
    const int guide = world.body(half, {X_W});
    for (const int other : {crank, rod}) world.exclude(other, guide);
  }
}

// Stretched out along x.
RattlingCrank rattlingCrank(const ClearanceCrank& m, const Vec3& rates, double h) {
  RattlingCrank made{Linkage(h, Vec3(0, -m.g, 0))};
  Linkage& world = made.world;
  const Vec3 A(m.crank, 0, 0), B(m.crank + m.rod, 0, 0), half_crank = A / 2, half_rod = (B - A) / 2;
  const int crank = world.ball(m.crank_mass, m.crank_inertia, half_crank);
  const int rod = world.ball(m.rod_mass, m.rod_inertia, A + half_rod);
  constexpr double kHalfWidth = 0.01;  // across the plane; nothing turns that way [m]
  engine::BodySpec spec{
      "slider", contact::Box{Vec3(m.half_length, m.half_height, kHalfWidth)}, true, m.slider_mass, {}};
  spec.material = {.mu_s = m.friction, .mu_d = m.friction, .restitution = m.restitution};
  spec.inertia = engine::GivenInertia{Vec3::Zero(), m.slider_inertia * Mat3::Identity()};
  const int slider = world.body(spec, {Pose{Quat::Identity(), B}});
  world.exclude(crank, slider);
  addGuide(m, spec.material, crank, rod, world);
  const auto hinge = [&](int a, const Vec3& p_A, int b, const Vec3& p_B) {
    return world.joint(jointAlong(JointKind::kPivot, Vec3::UnitZ(), a, p_A, b, p_B));
  };
  made.crank = hinge(crank, -half_crank, -1, Vec3::Zero());
  made.rod = hinge(rod, -half_rod, crank, half_crank);
  made.slider = hinge(slider, Vec3::Zero(), rod, half_rod);
  world.build();
  world.set(made.crank, 0, rates[0]);
  world.set(made.rod, 0, rates[1] - rates[0]);
  world.set(made.slider, 0, rates[2] - rates[1]);
  return made;
}

// The time from which on the run isn't compared.
double endOf(const ClearanceCrank::Run& run) {
  for (std::size_t i = 1; i < run.hits.size(); ++i) {
    if (run.hits[i].time - run.hits[i - 1].time < kAlone * kRattleTick) return run.hits[i].time;
  }
  return kLongest;
}

struct Rattle {
  double error = 0;  // of the corners' places [m]
  int flagged = 0;
};

// With ticks of kRattleTick / parts.
Rattle rattle(const ClearanceCrank& m, double slider_rate, int parts) {
  const Vec3 rates(kCrankRate, kRodRate, slider_rate);
  const ClearanceCrank::Run run = m.run({Vec3::Zero(), rates}, kRattleTick, kHits, kLongest);
  RattlingCrank engine = rattlingCrank(m, rates, kRattleTick / parts);
  const double end = endOf(run);
  double worst = 0;
  for (std::size_t n = 1; n < run.states.size() && static_cast<double>(n) * kRattleTick < end; ++n) {
    for (int part = 0; part < parts; ++part) engine.world.tick();
    for (int corner = 0; corner < 4; ++corner) {
      const Vec2 off = m.corner(corner, engine.angles()) - m.corner(corner, run.states[n].angle);
      worst = std::max(worst, off.norm());
    }
  }
  return {worst, engine.world.flagged};
}

struct Family {
  double worst = 0, least_ratio = kInfinity;  // of errors [m]; at kRattleTick over half of it
  int flagged = 0;
};

// Frictions and clearances about the paper's.
Family worstOf(const std::vector<double>& restitutions, const std::vector<double>& slider_rates) {
  Family family;
  const auto add = [&](const ClearanceCrank& m, double rate) {
    const Rattle coarse = rattle(m, rate, 1), fine = rattle(m, rate, 2);
    family.worst = std::max(family.worst, coarse.error);
    family.least_ratio = std::min(family.least_ratio, coarse.error / fine.error);
    family.flagged += coarse.flagged + fine.flagged;
  };
  for (const double e : restitutions) {
    for (const double mu : {0.0, 0.01, 0.1}) {
      for (const double c : {0.0005, 0.001, 0.002}) {
        ClearanceCrank m;
        m.restitution = e;
        m.friction = mu;
        m.clearance = c;
        for (const double rate : slider_rates) add(m, rate);
      }
    }
  }
  return family;
}

std::vector<Record> rattles(MeasureContext& context) {
  const Rattle paper = rattle({}, kFlat, 1);
  const Family bounces = worstOf({0.4, 0.9}, {kFlat, kTilting});
  context.progress(0.6);
  const Family slides = worstOf({0.0}, {kFlat}), turns = worstOf({0.0}, {kTilting});
  return {atMost("corners of the slider to the third hit, error", paper.error, "m", 1e-6),
          atMost("e .4 and .9, mu 0 to .1, clearance .5 to 2 mm, error", bounces.worst, "m", 2e-6),
          atLeast("the same at 50 over 25 us, errors", bounces.least_ratio, "-", 3),
          atMost("e 0: lands flat and slides on for 9 ms, error", slides.worst, "m", 2e-6),
          atLeast("the same at 50 over 25 us, errors", slides.least_ratio, "-", 3.5),
          // Its second corner lands slowly, at the end of a tick: first order, by the speed.
          atMost("e 0: lands on one corner, then flat, error", turns.worst, "m", 5e-5),
          exactly("flagged ticks", paper.flagged + bounces.flagged + slides.flagged + turns.flagged, "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyClearance() { return {{"tree/slider-crank-clearance", rattles}}; }

}  // namespace pincer::tasks
