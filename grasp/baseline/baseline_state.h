// baseline_state: what a finger of baseline.h remembers from tick to tick.
#pragma once
#include "contact/math.h"

namespace pincer::grasp {

struct BaselineState {
  bool has_proxy = false;
  int body = -1;             // on which the proxy rests, -1: none
  Vec3 p_P = Vec3::Zero();   // the proxy: in that body's frame, else in W [m]
  Vec3 p_WF = Vec3::Zero();  // of the device at the last tick [m]
};

}  // namespace pincer::grasp
