#include "pincer/tasks/judge/bench/grasp/bench_grasp.h"

#include <cmath>

#include "pincer/engine/world/island_sleep.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::tasks {

grasp::FingerModel benchFinger(const char* name, double stiffness, double damping) {
  grasp::FingerModel finger;
  finger.name = name;
  finger.radius = kBenchTip;
  finger.coupling.stiffness.setConstant(stiffness);
  finger.coupling.damping.setConstant(damping);
  return finger;
}

engine::WorldOptions benchWorld(bool gravity, bool sleep) {
  engine::WorldOptions options;
  if (!gravity) options.gravity_W.setZero();
  options.sleep = sleep;
  return options;
}

BenchGrasp::BenchGrasp(engine::WorldBuilder builder, const std::vector<engine::BodyStart>& bodies,
                       std::vector<grasp::FingerModel> fingers, const std::vector<Vec3>& devices,
                       const std::vector<grasp::FingerMethod>& methods)
    : inputs(fingers.size()),
      model(grasp::buildGrasp(std::move(builder), std::move(fingers))),
      state(grasp::makeState(model, bodies, devices)),
      scratch(grasp::makeScratch(model)) {
  if (!methods.empty()) baselines_.emplace(methods);
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].p_WF = devices[i];
}

void BenchGrasp::leadFinger(int finger, const Vec3& p_WF) {
  grasp::FingerInput& input = inputs[static_cast<std::size_t>(finger)];
  input.v_WF = (p_WF - input.p_WF) / kGraspTick;
  input.p_WF = p_WF;
}

void BenchGrasp::leadAll(const std::vector<Vec3>& p_WF, int ticks) {
  std::vector<Vec3> from;
  for (const grasp::FingerInput& input : inputs) from.push_back(input.p_WF);
  for (int k = 1; k <= ticks; ++k) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      leadFinger(static_cast<int>(i), from[i] + (p_WF[i] - from[i]) * k / ticks);
    tick();
  }
}

engine::StepReport BenchGrasp::tick() {
  const engine::StepReport report =
      baselines_ ? baselines_->step(model, state, *scratch, inputs) : grasp::step(model, state, *scratch, inputs);
  flagged_ += report.status != engine::kStepOk;
  watch();
  return report;
}

void BenchGrasp::watch() {
  const engine::WorldScratch& world = grasp::worldOf(*scratch);
  std::vector<Vec3> on_bodies(model.world.bodies.size(), Vec3::Zero());
  for (const engine::Contact& c : world.contacts) {
    if (!c.active()) continue;
    const double limit = c.mu * c.r[engine::kNormalRow],
                 torsion = engine::rowsOf(c.material) > 3 ? c.r[engine::kTorsionRow] : 0;
    if (limit > 0) cone_excess_ = std::max(cone_excess_, math::hypot(c.r.head<2>().norm(), torsion) / limit - 1);
    if (c.a.kind == engine::SideKind::kBody) on_bodies[static_cast<std::size_t>(c.a.index)] += c.impulse_W;
    on_bodies[static_cast<std::size_t>(c.b.index)] -= c.impulse_W;
  }
  bool same = true;
  for (std::size_t i = 0; i < on_bodies.size(); ++i)
    same = same && (engine::isIdle(world, static_cast<int>(i)) || on_bodies[i] == world.bodies[i].impulse_W);
  reaction_errors_ += !same;
}

}  // namespace pincer::tasks
