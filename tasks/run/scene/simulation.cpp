#include "pincer/tasks/run/simulation.h"

#include <algorithm>

namespace pincer::tasks {

namespace {

std::optional<grasp::BaselineFingers> baselinesOf(const Scene& scene) {
  const std::vector<grasp::FingerMethod> methods = methodsOf(scene);
  const bool are_ours = std::all_of(methods.begin(), methods.end(),
                                    [](grasp::FingerMethod m) { return m == grasp::FingerMethod::kProxy; });
  return are_ours ? std::nullopt : std::optional(grasp::BaselineFingers(methods));
}

}  // namespace

Simulation::Simulation(Scene scene)
    : scene_(std::move(scene)),
      model_(buildWorld(scene_)),
      state_(startState(scene_, model_)),
      scratch_(grasp::makeScratch(model_)),
      baselines_(baselinesOf(scene_)),
      inputs_(scene_.fingers.size()),
      motions_(scene_.motions.size()),
      controls_(scene_.drives.size()) {}

engine::StepReport Simulation::tick() { return tick(nextFingers()); }

std::span<const grasp::FingerInput> Simulation::nextFingers() {
  fingerInputs(scene_, static_cast<double>(ticks_ + 1) * scene_.options.h, inputs_);
  return inputs_;
}

engine::StepReport Simulation::tick(std::span<const grasp::FingerInput> fingers, const engine::AppliedForces& applied) {
  ++ticks_;
  bodyMotions(scene_, time(), motions_);
  driveControls(scene_, time(), controls_);
  if (baselines_) return baselines_->step(model_, state_, *scratch_, fingers, motions_, controls_);
  return grasp::step(model_, state_, *scratch_, fingers, motions_, applied, controls_);
}

}  // namespace pincer::tasks
