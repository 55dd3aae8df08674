// Bodies that nothing touches.
#include "tasks/exact/rigid_body.h"
#include "tasks/verify/scene_run.h"
#include "tasks/verify/verify.h"

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
      angle = angleBetween(exact::freeRotation(boxMoments(0.1, {0.01, 0.02, 0.04}), {0.02, 20, 0.02}, 1), sim.bodyPose(0).q);
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
    worst = std::max(worst, angleBetween(exact::symmetricTop(moments.x(), moments.z(), w, sim.time()), sim.bodyPose(0).q));
  });
  return {atMost("angle over 10 s (145 turns), largest error", worst, "rad", 1e-10)};
}

}  // namespace

std::vector<Measurement> verifyFreeBodies() { return {{"free/tumbling-box", tumblingBox}, {"free/symmetric-top", symmetricTop}}; }

}  // namespace pincer::tasks
