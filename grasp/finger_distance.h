// finger_distance: how far each finger is from each body, and where the two are nearest: for
// planning a grasp, and for pre-positioning.
#pragma once
#include <vector>

#include "pincer/grasp/step.h"

namespace pincer::grasp {

struct FingerDistance {
  int finger = 0, body = 0;
  double gap = 0;                  // [m]; negative when they overlap
  Vec3 p_finger_W = Vec3::Zero();  // the finger's point nearest to the body [m]
  Vec3 p_body_W = Vec3::Zero();    // and the body's: p_finger = p_body + gap n [m]
  Vec3 n_W = Vec3::UnitZ();        // outward normal of the body there
  Vec2 place_L = Vec2::Zero();     // on the pad, where it would touch [m]
};

// Of every finger and every body that it can touch, finger by finger, with the proxies and orientations of
// `state`. Searches each surface anew and allocates: off the tick. The tick itself reports each finger's nearest
// body within its reach (FingerReport::gap, nearest).
std::vector<FingerDistance> fingerDistances(const GraspModel& model, const GraspState& state);

}  // namespace pincer::grasp
