// hand_on_arm: a simulated hand on a simulated arm: mass, friction, a spring to where the hand wants to
// be, and the force that the device holds.
//
//   m x'' = f_held - b x' + k_h (x_wish - x) - b_h x'     integrated finely between two ticks
#pragma once
#include "pincer/contact/math.h"

namespace pincer::tasks {

struct HandOnArm {
  double mass = 0.05;           // [kg]
  double friction = 0.5;        // b, the arm's own [N s/m]
  double hand_stiffness = 300;  // k_h [N/m]
  double hand_damping = 2;      // b_h [N s/m]
  Vec3 p_W = Vec3::Zero(), v_W = Vec3::Zero(), wish_W = Vec3::Zero();

  void advance(const Vec3& f_held_W, double tick) {
    constexpr int kParts = 10;  // of a tick of 1 ms: 0.1 ms, far below m/(b + b_h) = 20 ms
    for (int i = 0; i < kParts; ++i) {
      v_W += tick / kParts / mass * (f_held_W - (friction + hand_damping) * v_W + hand_stiffness * (wish_W - p_W));
      p_W += tick / kParts * v_W;
    }
  }
};

}  // namespace pincer::tasks
