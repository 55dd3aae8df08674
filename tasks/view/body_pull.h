// body_pull: a hand that pulls a body of a simulation by a spring, from the place where it was taken.
//
//   f = m (w^2 (target - p) - 2 w v),  |f| <= 6 m g;   tau = r x f - w I omega;   w = 2 pi 4 Hz
//
//   p, v  of the place on the body [m], [m/s]; m, I its mass and inertia; r from its centre of mass to the place;
//   f and tau act at the centre, in W.
//   The second torque is ours: without it a body would swing about the hand for ever.
//
// Two threads: the viewer's takes, moves and lets go, the servo's asks for the force; they meet in a triple buffer.
#pragma once
#include <optional>
#include <vector>

#include "pincer/devices/triple_buffer.h"
#include "pincer/engine/step.h"
#include "pincer/grasp/model.h"

namespace pincer::tasks {

class BodyPull {
 public:
  explicit BodyPull(const grasp::GraspModel& model) : model_(model), forces_(model.world.bodies.size()) {}

  // The viewer's side. `p_B` [m] in the frame of `body`, which must be one that moves freely.
  void take(int body, const Vec3& p_B, const Vec3& target_W);
  void moveTo(const Vec3& target_W);
  void letGo();
  bool holds() const { return wanted_.body >= 0; }
  int body() const { return wanted_.body; }
  const Vec3& place_B() const { return wanted_.p_B; }

  // The servo's side: the pushes of a tick of `dt` [s] that begins with these bodies' poses; none while nothing is
  // held.
  engine::AppliedForces forces(const engine::WorldState& state, double dt);
  bool wasUsed() const { return used_; }

 private:
  struct Wish {
    int body = -1;
    Vec3 p_B = Vec3::Zero(), target_W = Vec3::Zero();
  };
  void publish();

  const grasp::GraspModel& model_;
  Wish wanted_;
  devices::TripleBuffer<Wish> wishes_;
  std::vector<engine::BodyForce> forces_;
  int held_ = -1;
  Vec3 before_W_ = Vec3::Zero();  // the place a tick ago
  bool used_ = false;
};

}  // namespace pincer::tasks
