// random_tree: trees of joints for the class `joints`: up to three chains of one to six links on the world, with
// branches, on pivots, sliders and balls in any direction; masses over 1e4, limits, springs, dampers, dry friction,
// armatures, drives of all kinds with and without limits; a box or ball among them.
#pragma once
#include <vector>

#include "pincer/engine/model.h"
#include "pincer/engine/state.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct RandomTree {
  std::vector<engine::BodySpec> bodies;
  std::vector<engine::BodyStart> starts;
  std::vector<engine::JointModel> joints;  // bodies from 0 on
  std::vector<engine::DriveModel> drives;
};

RandomTree drawTree(Random& random, const engine::Material& material);

// Draws the drives' controls for the next tick.
void drawControls(Random& random, const std::vector<engine::DriveModel>& drives,
                  std::vector<engine::DriveInput>& controls);

}  // namespace pincer::tasks
