#include "tasks/scene/simulation.h"

namespace pincer::tasks {

Simulation::Simulation(Scene scene)
    : scene_(std::move(scene)),
      model_(buildWorld(scene_)),
      state_(startState(scene_, model_)),
      scratch_(model_),
      inputs_(scene_.fingers.size()),
      motions_(scene_.motions.size()) {}

engine::StepReport Simulation::tick() {
  fingerInputs(scene_, static_cast<double>(ticks_ + 1) * scene_.options.h, inputs_);
  return tick(inputs_);
}

engine::StepReport Simulation::tick(std::span<const grasp::FingerInput> fingers) {
  ++ticks_;
  bodyMotions(scene_, time(), motions_);
  return grasp::step(model_, state_, scratch_, fingers, motions_);
}

}  // namespace pincer::tasks
