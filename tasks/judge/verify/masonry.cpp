// Piles and arches: they stand, or they don't.
#include "pincer/tasks/judge/exact/masonry.h"

#include <map>

#include "pincer/contact/polytope.h"
#include "pincer/tasks/judge/verify/scene_run.h"
#include "pincer/tasks/judge/verify/verify.h"

namespace pincer::tasks {
namespace {

constexpr int kStones = 16;                             // of the scene's arch
constexpr double kArchRadius = 0.2, kArchDepth = 0.05;  // of the scene [m]

// A wedge of the arch about its centre, upright.
contact::Shape stoneOf(double thickness) {
  const double half_angle = std::numbers::pi / kStones / 2;
  std::vector<Vec3> points;
  for (const double y : {-kArchDepth / 2, kArchDepth / 2}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double r : {1 - thickness / 2, 1 + thickness / 2})
        points.push_back(kArchRadius *
                         Vec3(r * side * math::sin(half_angle), y / kArchRadius, r * math::cos(half_angle)));
    }
  }
  return contact::Convex{contact::Polytope::hullOf(points, "stone")};
}

double largestTurn(const Simulation& sim) {
  double turn = 0;
  for (std::size_t i = 1; i < sim.scene().bodies.size(); ++i)
    turn = std::max(turn, angleBetween(sim.scene().starts[i].X_WB.q, sim.bodyPose(static_cast<int>(i)).q));
  return turn;
}

// True if some stone turns by more than 1e-4 rad in half a second.
bool archFalls(Scene scene, double thickness) {
  const contact::Shape stone = stoneOf(thickness);
  scene.duration = 0.5;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) scene.bodies[i].shape = stone;
  Simulation sim(std::move(scene));
  while (sim.ticks() < sim.scene().ticks()) {
    sim.tick();
    if (largestTurn(sim) > 1e-4) return true;
  }
  return false;
}

std::vector<Record> arch(MeasureContext& context) {
  const Scene scene = readBuiltinScene("masonry_arch");
  const double exact = exact::leastThicknessOfArch(kStones);
  int done = 0;
  const int steps = context.thorough ? 16 : 12;  // to 2e-7, or to 4e-6
  const double found = threshold(0.98 * exact, 1.01 * exact, steps, [&](double thickness) {
    context.progress(static_cast<double>(done++) / steps);
    return !archFalls(scene, thickness);
  });
  return {atMost("least thickness of 16 stones, relative error", std::abs(found / exact - 1), "-", 1e-5),
          atMost("Milankovitch's 0.1075: the exact answer of 10,000 stones, off by",
                 std::abs(exact::leastThicknessOfArch(10000) - 0.1075), "-", 5e-5)};
}

std::vector<Record> stack(MeasureContext& context) {
  Scene scene = readBuiltinScene("stack_of_ten");
  if (!context.thorough) scene.duration = 60;
  Simulation sim(std::move(scene));
  double moved = 0, turned = 0;
  const RunCount run = runThrough(sim, context, [&] {
    for (std::size_t i = 1; i < sim.scene().bodies.size(); ++i)
      moved = std::max(moved, (sim.bodyPose(static_cast<int>(i)).p - sim.scene().starts[i].X_WB.p).norm());
    turned = std::max(turned, largestTurn(sim));
  });
  return {atMost(context.thorough ? "ten boxes, 10 min: moved" : "ten boxes, 1 min: moved", 1e6 * moved, "um", 1e-6),
          atMost("turned", turned, "rad", 1e-9), exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

// Light below, 1 : 10 : 100 : 1000 : 10000: what each contact face carries after a second, against the weight above it.
std::vector<Record> massRatio(MeasureContext& context) {
  Simulation sim(readBuiltinScene("s6_stack"));
  const auto& bodies = sim.model().world.bodies;
  double force_error = 0, sunk = 0;
  const RunCount run = runThrough(sim, context, [&] {
    for (std::size_t i = 1; i < bodies.size(); ++i)
      sunk = std::max(sunk, std::abs(sim.bodyPose(static_cast<int>(i)).p.z() - sim.scene().starts[i].X_WB.p.z()));
    if (sim.time() < 1) return;
    std::map<int, double> carried;  // by the upper body of a face: its lower body pushes it up
    const engine::WorldScratch& world = grasp::worldOf(sim.scratch());
    for (int k = 0; k < engine::contactCount(world); ++k) {
      const engine::ContactReport c = engine::contactAt(world, k);
      carried[std::max(c.other_body, c.body)] += std::abs(c.f_W.z());
    }
    double weight = 0;
    for (int i = static_cast<int>(bodies.size()) - 1; i > 0; --i) {
      weight += bodies[static_cast<std::size_t>(i)].mass * kVerifyG;
      force_error = std::max(force_error, std::abs(carried[i] / weight - 1));
    }
  });
  return {atMost("force on a face over the weight above, less 1", force_error, "-", 1e-6),
          atMost("sunk or risen", 1e6 * sunk, "um", 1e-6),
          exactly("flagged ticks", static_cast<double>(run.flagged), "-", 0)};
}

}  // namespace

std::vector<Measurement> verifyMasonry() {
  return {{"stand/arch", arch}, {"stand/stack-of-ten", stack}, {"stand/mass-ratio", massRatio}};
}

}  // namespace pincer::tasks
