// pickup_scene: the set-up of one trial of sphere pickup: dish, object, two fingers (hand_scene.h).
#pragma once
#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/sphere_pickup.h"

namespace pincer::tasks {

HandScene makePickupScene(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec);

// Gap between the object and the dish [m]; more than 0.3 m reads as 0.3.
double clearanceOverDish(const HandScene& scene, const Pose& X_WB, contact::PatchCache& patches);

}  // namespace pincer::tasks
