// Blocks and ladders that stand, tip, rock and jam.
#include "pincer/tasks/judge/exact/toppling.h"

#include "pincer/engine/motion/mass.h"
#include "pincer/engine/world/scratch.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

// Bisection of the slope that tips a block: a turn of 1e-7 rad within 1 s, which an excess of 1e-10 causes.
std::vector<Record> tipping(MeasureContext& context) {
  const Scene scene = readBuiltinScene("tipping_block");
  int done = 0;
  const auto tips = [&](double tangent) {
    context.progress(done++ / 30.0);
    Scene trial = scene;
    trial.options.gravity_W = tiltedGravity(math::atan(tangent), 0);
    Simulation sim(std::move(trial));
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    return angleBetween(Quat::Identity(), sim.bodyPose(1).q) > 1e-7;
  };
  return {atMost("tangent of the slope that tips it over b/h, less 1",
                 std::abs(threshold(0.45, 0.55, 30, tips) / 0.5 - 1), "-", 1e-7)};
}

std::vector<Record> rocking(MeasureContext& context) {
  Simulation sim(readBuiltinScene("rocking_block"));
  const exact::RockingBlock exact{0.03, 0.09, kVerifyG};
  constexpr double kTilt = 0.15;  // [rad]
  double fallen = std::nan(""), peak = 0, before = kTilt;
  runThrough(sim, context, [&] {
    const Quat q = sim.bodyPose(1).q;
    const double tilt = 2 * math::atan2(q.y(), q.w());
    if (std::isnan(fallen) && tilt < 0) fallen = sim.time() - 1e-3 * tilt / (tilt - before);
    peak = std::max(peak, -tilt);
    before = tilt;
  });
  return {atMost("time to fall upright, relative error", std::abs(fallen / exact.fallTime(kTilt) - 1), "-", 1e-3),
          // Second order: the tick is cut where it lands.
          atMost("peak after the first impact, relative error", std::abs(peak / exact.nextPeak(kTilt) - 1), "-", 1e-3)};
}

std::vector<Record> ladder(MeasureContext& context) {
  const Scene scene = readBuiltinScene("ladder");
  constexpr double kLength = 1, kRadius = 0.01, kMu = 0.4;  // [m], [m], [-]
  int done = 0;
  const auto stands = [&](double angle) {
    context.progress(done++ / 26.0);
    Scene trial = scene;
    trial.duration = 0.5;
    trial.starts[2].X_WB.p = {-kRadius - 0.5 * kLength * math::cos(angle), 0,
                              kRadius + 0.5 * kLength * math::sin(angle)};
    trial.starts[2].X_WB.q = quatFromRotationVector({0, std::numbers::pi / 2 - angle, 0});
    Simulation sim(std::move(trial));
    const Quat start = sim.bodyPose(2).q;
    MeasureContext quiet;
    runThrough(sim, quiet, [] {});
    return angleBetween(start, sim.bodyPose(2).q) < 1e-8;
  };
  const double exact = exact::leastAngleOfLadder(kMu, kLength, kRadius);
  const double found = threshold(exact - 2 * kDegree, exact + 2 * kDegree, 26, stands);
  return {atMost("least angle at which it stands, error", std::abs(found - exact), "rad", 1e-6)};
}

// One tick of Painleve's rod at several tick lengths: the jam's impulse, whatever the tick.
std::vector<Record> painleve(MeasureContext&) {
  const Scene scene = readBuiltinScene("painleve_rod");
  double worst = 0, gained = 0, sinking = 0;
  for (const double h : {1e-4, 5e-5, 1e-5}) {
    Scene trial = scene;
    trial.options.h = trial.duration = h;
    Simulation sim(std::move(trial));
    const engine::BodyModel& body = sim.model().world.bodies[1];
    const Vec3 tip = sim.bodyPose(1) * Vec3(0, 0, -0.15) - Vec3(0, 0, 0.001) - sim.bodyPose(1).p;
    const exact::Jam exact = exact::jamOfTip(body.mass, body.moments.maxCoeff(), {tip.x(), tip.z()}, {-1, 0});
    const double energy = engine::kineticEnergy(sim.model().world, sim.state().world);
    sim.tick();
    const engine::BodyState& state = sim.state().world.bodies[1];
    worst = std::max(worst, (Vec2(state.v_W.x(), state.v_W.z()) - exact.v).norm());
    gained = std::max(gained, engine::kineticEnergy(sim.model().world, sim.state().world) / energy - 1);
    sinking = std::max(sinking, -grasp::worldOf(sim.scratch()).contacts.front().u_C.z());
  }
  // In one tick of 0.1 ms gravity alone changes a velocity by 1e-3 m/s, and the tick's geometry is that of its middle.
  return {atMost("velocity after the jam over three ticks, error", worst, "m/s", 5e-3),
          atMost("energy gained, relative", gained, "-", 0),
          atMost("tip's velocity into the floor", sinking, "m/s", 1e-9)};
}

}  // namespace

std::vector<Measurement> verifyToppling() {
  return {{"topple/tipping", tipping},
          {"topple/rocking", rocking},
          {"topple/ladder", ladder},
          {"topple/painleve", painleve}};
}

}  // namespace pincer::tasks
