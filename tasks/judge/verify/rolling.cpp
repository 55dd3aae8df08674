// Spheres that slide, roll and spin; a disk that rolls on its rim.
#include "pincer/tasks/judge/exact/rigid_body.h"
#include "pincer/tasks/judge/exact/sliding_rolling.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

std::vector<Record> slideToRoll(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s2_slide_to_roll"));
  const exact::SlideToRoll exact{1, 0.2, kVerifyG};
  double rise = 0;
  const RunCount run = runThrough(sim, context, [&] { rise = std::max(rise, std::abs(sim.bodyPose(1).p.z() - 0.02)); });
  return {atMost("position at 1 s, error", 1e3 * std::abs(sim.bodyPose(1).p.x() - exact.position(1)), "mm", 1e-3),
          atMost("velocity at 1 s, relative error",
                 std::abs(sim.state().world.bodies[1].v_W.x() / exact.velocity(1) - 1), "-", 1e-6),
          atMost("height, largest deviation", 1e3 * rise, "mm", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Rolls if and only if mu >= 2/7 tan th; way and turn after 1 s.
std::vector<Record> incline(MeasureContext& context) {
  const Scene scene = readBuiltinScene("rolling_incline");
  constexpr double kTheta = std::numbers::pi / 6, kRadius = 0.02;  // [rad], [m], as in the scene
  double way_error = 0, turn_error = 0;
  int done = 0;
  for (const double ratio : {0.3, 0.99, 1.01, 3.0}) {
    context.progress(done++ / 4.0);
    const exact::RollingIncline exact{kTheta, ratio * 2 / 7 * math::tan(kTheta), kVerifyG};
    Scene trial = scene;
    trial.options.gravity_W = tiltedGravity(kTheta, 0);
    setFriction(trial, exact.mu);
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    const double t = sim.time(), w = engine::bodyAngularVelocity(sim.model().world, sim.state().world, 1).y();
    way_error = std::max(way_error, std::abs(sim.bodyPose(1).p.x() / (0.5 * exact.acceleration() * t * t) - 1));
    turn_error = std::max(turn_error, std::abs(kRadius * w / (exact.surfaceAcceleration() * t) - 1));
  }
  return {atMost("way over 4 frictions, relative error", way_error, "-", 1e-9),
          atMost("spin, relative error", turn_error, "-", 1e-9)};
}

std::vector<Record> spinDown(MeasureContext& context) {
  Simulation sim(readBuiltinScene("spin_down"));
  const exact::SpinDown exact{50, 0.02, 0.4, 0.003, kVerifyG};
  double worst = 0, stopped = std::nan("");
  runThrough(sim, context, [&] {
    const double w = engine::bodyAngularVelocity(sim.model().world, sim.state().world, 1).z();
    const double t = sim.time();
    if (t < exact.time()) worst = std::max(worst, std::abs(w - (exact.w0 - exact.deceleration() * t)));
    if (std::isnan(stopped) && std::abs(w) < 1e-9) stopped = t;
  });
  return {atMost("angular velocity, largest error of its start", worst / exact.w0, "-", 1e-9),
          atMost("time until it stops, error", 1e3 * std::abs(stopped - exact.time()), "ms", 1)};
}

std::vector<Record> resistance(MeasureContext& context) {
  Simulation sim(readBuiltinScene("rolling_resistance"));
  const exact::RollingResistance exact{0.1, 0.02, 0.5, 2e-3, kVerifyG};
  double speed_error = 0, way_error = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const double t = sim.time(), v = sim.state().world.bodies[1].v_W.x();
    if (t > exact.time()) return;
    speed_error = std::max(speed_error, std::abs(v - (exact.v0 - exact.deceleration() * t)) / exact.v0);
    way_error = std::max(way_error, std::abs(sim.bodyPose(1).p.x() - exact.way(t)));
  });
  // Even forces, so that the scheme is exact but for the solver's tolerance; the tick in which it
  // stops, at v <= a h, is of first order: a h^2.
  return {
      atMost("speed, largest error of its start", speed_error, "-", 1e-8),
      atMost("way, largest error", 1e6 * way_error, "um", 2e-3),
      atMost("way until it stops, error", 1e6 * std::abs(sim.bodyPose(1).p.x() - exact.way(exact.time())), "um", 0.35),
      exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Angle by which the disk's axis has gone round, against W t; and how far its centre has moved, which should rest.
std::vector<Record> eulersDisk(MeasureContext& context) {
  Simulation sim(readBuiltinScene("euler_disk"));
  const double inclination = 40 * std::numbers::pi / 180;
  const double W = exact::precessionOfEulersDisk(0.05, 0.002, inclination, kVerifyG);
  const Vec3 start = sim.bodyPose(1).p;
  double moved = 0, lag = 0, energy_error = 0;
  const double energy = sim.moment().state.world.time == 0
                            ? engine::kineticEnergy(sim.model().world, sim.state().world) +
                                  engine::potentialEnergy(sim.model().world, sim.state().world)
                            : 0;
  runThrough(sim, context, [&] {
    const Pose X = sim.bodyPose(1);
    const Vec3 axis = X.q * Vec3::UnitZ();
    const double angle = math::atan2(axis.y(), axis.x());
    lag = std::max(lag, std::abs(std::remainder(angle - W * sim.time(), 2 * std::numbers::pi)));
    moved = std::max(moved, (X.p - start).norm());
    const double now = engine::kineticEnergy(sim.model().world, sim.state().world) +
                       engine::potentialEnergy(sim.model().world, sim.state().world);
    energy_error = std::max(energy_error, now / energy - 1);
  });
  return {atMost("precession in 0.5 s, error over angle", lag / (W * 0.5), "-", 2e-3),
          // The rest of the tick in which it lands, and of a stick that holds at the arms of the tick's middle.
          atMost("centre moved, over the radius", moved / 0.05, "-", 2e-3),
          atMost("energy gained, relative", energy_error, "-", 1e-6)};
}

// A ball between two plates that move past each other: at every tick half of their ways
// together, turned by half of their difference.
std::vector<Record> betweenPlates(MeasureContext& context) {
  Simulation sim(readBuiltinScene("ball_between_plates"));
  const Vec3 start1 = sim.bodyPose(0).p, start2 = sim.bodyPose(3).p, start = sim.bodyPose(1).p;
  double way_error = 0, turn_error = 0;
  const RunCount run = runThrough(sim, context, [&] {
    const exact::RolledBall exact =
        exact::rolledBetweenPlates(0.02, sim.bodyPose(0).p - start1, sim.bodyPose(3).p - start2);
    way_error = std::max(way_error, (sim.bodyPose(1).p - start - exact.way).norm());
    turn_error = std::max(turn_error, angleBetween(quatFromRotationVector(exact.turn), sim.bodyPose(1).q));
  });
  // Second order in the tick: the plates' way in a tick isn't quite the mean of their velocities
  // at its ends. All is undone when they rest.
  return {atMost("way, largest error", 1e6 * way_error, "um", 2e-2),
          atMost("turn, largest error", turn_error, "rad", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyRolling() {
  return {{"roll/slide-to-roll", slideToRoll}, {"roll/incline", incline},    {"roll/between-plates", betweenPlates},
          {"roll/resistance", resistance},     {"roll/spin-down", spinDown}, {"roll/eulers-disk", eulersDisk}};
}

}  // namespace pincer::tasks
