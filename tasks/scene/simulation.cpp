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
  ++ticks_;
  fingerInputs(scene_, time(), inputs_);
  bodyMotions(scene_, time(), motions_);
  return grasp::step(model_, state_, scratch_, inputs_, motions_);
}

}  // namespace pincer::tasks
