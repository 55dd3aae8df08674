// Bodies that nothing touches; one stands on its tip.
#include "pincer/tasks/judge/exact/rigid_body.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

Vec3 boxMoments(double mass, const Vec3& half) {
  return mass / 3 *
         Vec3(half.y() * half.y() + half.z() * half.z(), half.x() * half.x() + half.z() * half.z(),
              half.x() * half.x() + half.y() * half.y());
}

// About its middle axis a body is unstable (the tennis racket): it turns over, when Euler's equations say.
std::vector<Record> tumblingBox(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s1_tumbling_box"));
  const auto& world = sim.model().world;
  const double energy = engine::kineticEnergy(world, sim.state().world);
  const Vec3 momentum = sim.state().world.bodies[0].L_W;
  double energy_drift = 0, momentum_drift = 0, angle = std::nan("");
  runThrough(sim, context, [&] {
    energy_drift = std::max(energy_drift, std::abs(engine::kineticEnergy(world, sim.state().world) / energy - 1));
    momentum_drift = std::max(momentum_drift, (sim.state().world.bodies[0].L_W - momentum).norm() / momentum.norm());
    if (sim.ticks() == 1000)
      angle = angleBetween(exact::freeRotation(boxMoments(0.1, {0.01, 0.02, 0.04}), {0.02, 20, 0.02}, 1),
                           sim.bodyPose(0).q);
  });
  return {atMost("angle at 1 s, error", angle, "rad", 1e-6), atMost("energy drift in 60 s", energy_drift, "-", 1e-7),
          atMost("angular momentum drift in 60 s", momentum_drift, "-", 1e-14)};
}

// A body with two equal moments precesses regularly: exact to round-off.
std::vector<Record> symmetricTop(MeasureContext& context) {
  Scene scene = readBuiltinScene("s1_tumbling_box");
  scene.duration = 10;
  scene.bodies[0].shape = contact::Box{{0.02, 0.02, 0.005}};
  const Vec3 moments = boxMoments(0.1, {0.02, 0.02, 0.005}), w(15, -4, 90);
  scene.starts[0].w_W = w;
  Simulation sim(std::move(scene));
  double worst = 0;
  runThrough(sim, context, [&] {
    worst =
        std::max(worst, angleBetween(exact::symmetricTop(moments.x(), moments.z(), w, sim.time()), sim.bodyPose(0).q));
  });
  return {atMost("angle over 10 s (145 turns), largest error", worst, "rad", 1e-10)};
}

exact::HeavyTop heavyTopOfScene() {
  constexpr double kMass = 0.1, kRadius = 0.03, kLength = 0.01, kLever = 0.04;  // [kg], [m]
  const double across = kMass * (3 * kRadius * kRadius + kLength * kLength) / 12;
  return {kMass, kLever, across + kMass * kLever * kLever, kMass * kRadius * kRadius / 2, 200, kVerifyG};
}

// How far the axis is from where it should be after every 0.1 s, at most [rad]; its
// heading rate at the start is `heading_rate`.
double axisError(Scene scene, double heading_rate, MeasureContext& context) {
  const exact::HeavyTop top = heavyTopOfScene();
  constexpr double kAngle = std::numbers::pi / 6;  // of the axis to the vertical [rad], as in the scene
  const Vec3 axis(math::sin(kAngle), 0, math::cos(kAngle));
  const Vec3 w_W = Vec3(0, 0, heading_rate) + (top.w3 - heading_rate * axis.z()) * axis;
  scene.starts[0].w_W = w_W;
  scene.starts[0].v_W = w_W.cross(top.lever * axis);
  Simulation sim(std::move(scene));
  double worst = 0;
  const auto every = static_cast<std::int64_t>(std::lround(0.1 / sim.scene().options.h));
  runThrough(sim, context, [&] {
    if (sim.ticks() % every != 0) return;
    const Vec3 exact = top.axisAfter(sim.time(), kAngle, heading_rate);
    worst = std::max(worst, (sim.bodyPose(0).q * Vec3::UnitZ() - exact).norm());
  });
  return worst;
}

// On its tip: steady precession, and the nutation of a top whose axis is let go at rest.
std::vector<Record> heavyTop(MeasureContext& context) {
  Scene scene = readBuiltinScene("heavy_top");
  const double steady = axisError(scene, heavyTopOfScene().slowPrecession(std::numbers::pi / 6), context);
  scene.duration = 2;
  const double nutating = axisError(scene, 0, context);
  scene.options.h = 5e-4;
  const double finer = axisError(scene, 0, context);
  // Joints are second order in the tick, in which this top turns by 0.2 rad: a quarter of the error at half the tick.
  return {atMost("axis in 10 s of steady precession, error", steady, "rad", 1e-2),
          atMost("axis in 2 s of nutation, error", nutating, "rad", 2e-2),
          atLeast("nutation at 1 ms over 0.5 ms, errors", nutating / finer, "-", 3.5)};
}

}  // namespace

std::vector<Measurement> verifyFreeBodies() {
  return {{"free/tumbling-box", tumblingBox}, {"free/symmetric-top", symmetricTop}, {"free/heavy-top", heavyTop}};
}

}  // namespace pincer::tasks
