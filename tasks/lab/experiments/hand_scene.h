// hand_scene: a pinching hand at an object: two fingers on arms that face each
// other, shared by both manipulation tasks.
//
//   finger 0 (index) comes from -x, finger 1 (thumb) from +x; arm base frames D: z towards the object, y up; finger
//   frames F: pad (-z) towards the object, distal (x) away from the operator (+y)
// Arm bases stand so that the fingertips at the arms' reset places (p_DF = 0) are
// where the fingers wait for the start tone.
#pragma once
#include <array>
#include <vector>

#include "pincer/tasks/lab/experiments/hand_setup.h"
#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/tick/tick.h"

namespace pincer::tasks {

struct HandScene {
  TickModel model;
  std::vector<engine::BodyStart> starts;
  std::array<Vec3, kHandFingers> homes_W;  // of the fingertips [m]
  std::array<Quat, kHandFingers> q_DF;     // of the fingers on their arms, as the gimbals read it
  TrialCues cues;
  int object = 0;  // the body that is to be manipulated
};

// Two fingers beside `place_W`, the middle of the object between them, whose half width there is
// `half_width`. The cues are told of arms, fingers and place; the rest of them is the task's.
// `display_tactile` false: the tactors stay parked.
HandScene makeHandScene(const HandSetup& setup, engine::WorldBuilder world, std::vector<engine::BodyStart> starts,
                        const Vec3& place_W, double half_width, bool display_tactile);

// Moves the arms' bases by their calibrations; the fingers themselves stay. Throws InputError unless each arm's z
// points at the other, within 30 degrees: forces would go elsewhere than where the fingers are.
void standArms(HandScene& scene, const std::array<ArmBase, kHandFingers>& bases);

// A fresh state: everything at its start, gates armed.
TickState makeHandState(const HandScene& scene);

}  // namespace pincer::tasks
