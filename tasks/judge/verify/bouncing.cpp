// Bodies that hit each other.
#include "pincer/tasks/judge/exact/bouncing.h"

#include <fmt/format.h>

#include <limits>

#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

// Heights of the first five bounces, from place and velocity on the way (z + v^2/(2 g) is
// the peak's), and when all bounces are over.
std::vector<Record> fading(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s7_bounce"));
  constexpr double kRadius = 0.02;  // [m]
  const exact::DroppedBall exact{0.5, 0.8, kVerifyG};
  double worst = 0, moved_until = 0, v_before = 0;
  int bounces = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const double v = sim.state().world.bodies[1].v_W.z();
    if (v_before < 0 && v > 0) {
      const double peak = sim.bodyPose(1).p.z() - kRadius + v * v / (2 * kVerifyG);
      if (++bounces <= 5) worst = std::max(worst, std::abs(peak / exact.peak(bounces) - 1));
    }
    if (std::abs(v) > 1e-9) moved_until = sim.time();
    v_before = v;
  });
  return {atMost("five peaks against e^(2n) h, relative error", worst, "-", 1e-9),
          atLeast("bounces seen", bounces, "-", 5),
          // Bounces of which all that follow last less than a tick aren't followed (decision 11).
          atMost("time until all bounces are over, error", 1e3 * std::abs(moved_until - exact.restTime()), "ms", 2),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

std::vector<Record> lossless(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s7_superball"));
  const auto energy = [&] {
    return engine::kineticEnergy(sim.model().world, sim.state().world) +
           engine::potentialEnergy(sim.model().world, sim.state().world);
  };
  const double start = energy();
  double drift = 0;
  runThrough(sim, context, [&] { drift = std::max(drift, std::abs(energy() / start - 1)); });
  return {atMost("e = 1: energy over 60 s, relative change", drift, "-", 1e-12)};
}

// With spin: hits that slip all through take 2 mu |v_z| of it each, until one
// grips. Place, velocity and spin at every tick.
std::vector<Record> spinning(MeasureContext& context) {
  Simulation sim(readBuiltinScene("spinning_superball"));
  const exact::SpinningBall ball{0.02, 1, 0.1, kVerifyG};
  const engine::BodyStart& start = sim.scene().starts[1];
  double place = 0, velocity = 0, spin = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const auto exact = ball.after({start.X_WB.p, start.v_W, start.w_W}, sim.time());
    const Vec3 v = sim.state().world.bodies[1].v_W,
               w = engine::bodyAngularVelocity(sim.model().world, sim.state().world, 1);
    place = std::max(place, (sim.bodyPose(1).p - exact.p).norm());
    velocity = std::max(velocity, Vec2((v - exact.v).head<2>()).norm());
    spin = std::max(spin, (w - exact.w).norm());
  });
  return {atMost("place over 3 s, largest error", 1e6 * place, "um", 1e-3),
          atMost("velocity along the floor, largest error", velocity, "m/s", 1e-9),
          atMost("spin, largest error", spin, "rad/s", 1e-7),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// How a plate and the ball that comes at it at 10 m/s are to be.
struct PlateCase {
  double h, plate_mass, restitution;  // tick [s]; infinite mass: it never moves
};

// Largest distance of ball and plate from where they should be at the end of a tick, after the hit or without one [m].
double plateError(Scene scene, const PlateCase& c, double start) {
  // of the ball; height of its centre when it touches [m]
  constexpr double kMass = 0.01, kContact = 0.0055, kSpeed = 10;
  scene.options.h = c.h;
  scene.starts[1].X_WB.p.z() = start;
  for (engine::BodySpec& body : scene.bodies) body.material.restitution = c.restitution;
  scene.bodies[0].dynamic = std::isfinite(c.plate_mass);
  scene.bodies[0].mass = scene.bodies[0].dynamic ? c.plate_mass : 0;
  const double hit = (start - kContact) / kSpeed;
  const Vec2 after = exact::HeadOn{kMass, c.plate_mass, c.restitution}.velocities(-kSpeed);
  Simulation sim(std::move(scene));
  MeasureContext quiet;
  double worst = 0;
  runThrough(sim, quiet, [&] {
    const double t = sim.time() - hit;
    const double ball = kContact + (t < 0 ? -kSpeed : after[0]) * t, plate = t < 0 ? 0 : after[1] * t;
    worst = std::max({worst, std::abs(sim.bodyPose(1).p.z() - ball), std::abs(sim.bodyPose(0).p.z() - plate)});
  });
  return worst;
}

// Tunnelling: a ball of 5 mm at 10 m/s against a plate of 1 mm, in many phases of ticks from 0.1
// to 10 ms, in which it goes up to 100 mm.
std::vector<Record> tunnelling(MeasureContext& context) {
  const Scene scene = readBuiltinScene("ball_at_plate");
  constexpr int kPhases = 20;  // of ten ticks: half a tick apart; chosen
  std::vector<Record> records;
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    double worst = 0;
    for (const double plate_mass : {std::numeric_limits<double>::infinity(), 0.027}) {
      for (const double e : {0.0, 0.5, 1.0}) {
        for (int k = 0; k < kPhases; ++k)
          worst = std::max(worst, plateError(scene, {h, plate_mass, e}, 0.2 + 10 * h * k / kPhases));
      }
    }
    records.push_back(
        atMost(fmt::format("ball and plate, ticks of {} ms, largest error", 1e3 * h), 1e6 * worst, "um", 1e-3));
    context.progress(static_cast<double>(records.size()) / 3);
  }
  return records;
}

}  // namespace

std::vector<Measurement> verifyBouncing() {
  return {{"bounce/fading", fading},
          {"bounce/lossless", lossless},
          {"bounce/spinning", spinning},
          {"bounce/tunnelling", tunnelling}};
}

}  // namespace pincer::tasks
