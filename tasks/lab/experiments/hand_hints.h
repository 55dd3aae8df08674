// hand_hints: the next thing to do for somebody at a mouse, who can't feel: how to bring two fingers beside an object,
// and which way to turn it. W: x right, y away from the operator, z up.
#pragma once
#include "pincer/contact/math.h"

namespace pincer::tasks {

struct HandPlaces {
  Vec3 index_W, thumb_W;                      // of the fingertips [m]
  Vec3 middle_W;                              // of the object [m]
  double half_width = 0.02, reach_up = 5e-3;  // of the object; how far over its middle a pinch may be [m]
};

// Empty once both fingers are beside the object, one on either side.
const char* reachHint(const HandPlaces& places);

// Of the line from finger to finger about W's z axis, within a quarter turn [rad].
double handTurn(const HandPlaces& places);

// `needed`: by which the object is to be turned [rad], to the left if positive; `pinches`: both fingers hold it.
const char* turnHint(double hand_turn, double needed, bool pinches);

}  // namespace pincer::tasks
