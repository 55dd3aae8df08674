#include "pincer/tasks/view/body_pull.h"

#include <algorithm>
#include <numbers>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr double kStiff = 2 * std::numbers::pi * 4;  // w [rad/s]: a hand; it sags by 16 mm under the body's weight
constexpr double kStrongest = 6 * 9.81;              // of the acceleration [m/s^2]

}  // namespace

void BodyPull::publish() {
  wishes_.writable() = wanted_;
  wishes_.publish();
}

void BodyPull::take(int body, const Vec3& p_B, const Vec3& target_W) {
  PINCER_ASSERT(body >= 0 && body < static_cast<int>(model_.world.bodies.size()));
  wanted_ = {body, p_B, target_W};
  publish();
}

void BodyPull::moveTo(const Vec3& target_W) {
  wanted_.target_W = target_W;
  publish();
}

void BodyPull::letGo() {
  wanted_.body = -1;
  publish();
}

engine::AppliedForces BodyPull::forces(const engine::WorldState& state, double dt) {
  PINCER_ASSERT(dt > 0);
  wishes_.update();
  const Wish& wish = wishes_.current();
  if (held_ >= 0) forces_[static_cast<std::size_t>(held_)] = {};
  const bool goes_on = held_ >= 0 && held_ == wish.body;
  held_ = wish.body;
  if (held_ < 0) return {};
  used_ = true;
  const engine::BodyModel& body = model_.world.bodies[static_cast<std::size_t>(held_)];
  const Pose X_WB = engine::bodyPose(model_.world, state, held_);
  const Vec3 p_W = X_WB * wish.p_B;
  const Vec3 v_W = goes_on ? Vec3((p_W - before_W_) / dt) : Vec3(Vec3::Zero());
  before_W_ = p_W;
  Vec3 a_W = kStiff * kStiff * (wish.target_W - p_W) - 2 * kStiff * v_W;
  a_W *= std::min(1.0, kStrongest / std::max(a_W.norm(), kStrongest));
  const Vec3 f_W = body.mass * a_W, arm_W = p_W - X_WB * body.X_BI.p;
  const Mat3 R_WI = (X_WB.q * body.X_BI.q).toRotationMatrix();
  const Vec3 w_W = engine::bodyAngularVelocity(model_.world, state, held_);
  const Vec3 calming_W = -kStiff * (R_WI * body.moments.asDiagonal() * R_WI.transpose() * w_W);
  forces_[static_cast<std::size_t>(held_)] = {f_W, arm_W.cross(f_W) + calming_W};
  return {.forces = forces_};
}

}  // namespace pincer::tasks
