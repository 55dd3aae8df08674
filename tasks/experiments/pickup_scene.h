// pickup_scene: the set-up of one trial: dish, object, two fingers on arms that face each other.
//
//   finger 0 (index) comes from -x, finger 1 (thumb) from +x; arm base frames D: z towards the object, y up; finger frames F: pad (-z) towards
//   the object, distal (x) away from the operator (+y)
// Arm bases stand so that the fingertips at the arms' reset places (p_DF = 0) are where the fingers wait for the start tone.
#pragma once
#include <array>
#include <vector>

#include "tasks/experiments/pickup_object.h"
#include "tasks/experiments/sphere_pickup.h"
#include "tasks/participants/participant.h"
#include "tasks/servo/tick.h"

namespace pincer::tasks {

struct PickupScene {
  TickModel model;
  std::vector<engine::BodyStart> starts;
  std::array<Vec3, kHandFingers> homes_W;  // of the fingertips [m]
  std::array<Quat, kHandFingers> q_DF;     // of the fingers on their arms, as the gimbals read it
  TrialCues cues;
};

PickupScene makePickupScene(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec);

// A fresh state: everything at its start, gates armed.
TickState makePickupState(const PickupScene& scene);

// Gap between the object and the dish [m]; more than 0.3 m reads as 0.3.
double clearanceOverDish(const PickupScene& scene, const Pose& X_WB, contact::PatchCache& patches);

}  // namespace pincer::tasks
