// finger_scene: one finger on one fixed body in a world without gravity: what a haptics lab builds first.
//
// The finger is a massless tip of radius 8 mm behind a spring of 1000 N/m, as in the measurements of CHAI3D that
// docs/benchmarks.md names; the device leads it at 1 kHz.
#pragma once
#include "pincer/grasp/step.h"

namespace pincer::tasks {

class FingerScene {
 public:
  static constexpr double kStiffness = 1000;  // [N/m]

  // The device begins at `p_WF` [m], outside the body, whose frame is the world's.
  FingerScene(contact::Shape shape, const engine::Material& material, const Vec3& p_WF);

  // One tick with the device at `p_WF` at its end [m].
  const grasp::FingerReport& tick(const Vec3& p_WF);

  // Leads the device straight to `p_WF` [m] at 100 mm/s.
  void leadTo(const Vec3& p_WF);

  const Vec3& proxy() const { return state_.world.points.front().p_W; }  // centre of the fingertip on the surface [m]
  int flagged() const { return flagged_; }                               // ticks that the step complained of
  // Between two walls that push and lock: mu > tan(alpha), pi - 2 alpha the angle
  // between their normals (engine/world/wedge.h).
  bool isLocked() const;

 private:
  grasp::GraspModel model_;
  grasp::GraspState state_;
  grasp::ScratchHandle scratch_;
  Vec3 device_;
  int flagged_ = 0;
};

}  // namespace pincer::tasks
