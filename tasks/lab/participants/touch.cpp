#include "pincer/tasks/lab/participants/touch.h"

#include <algorithm>
#include <cmath>

namespace pincer::tasks {

void Touch::begin(const SensingLimits& limits, const TrialCues& cues, const BodySense& sense) {
  *this = Touch();
  limits_ = limits;
  cues_ = cues;
  push_W_.fill(Vec3::Zero());
  place_before_.fill(Vec2::Zero());
  sense_ = sense;
}

void Touch::feel(const Percept& percept) {
  const double dt = begun_ ? std::max(percept.time - percept_.time, 0.0) : 0;
  begun_ = true;
  percept_ = percept;
  for (int i = 0; i < kHandFingers; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const FingerPercept& finger = percept.fingers[k];
    if (dt > 0) push_W_[k] += (cues_.fingers[k].q_WD * finger.f_D - push_W_[k]) * dt / (limits_.force_lag + dt);
    force_[k] = std::max(0.0, -push_W_[k].dot(padAxis_W(i, cues_.fingers[k].pad_normal_F)));
    touched_for_[k] = push_W_[k].norm() > limits_.force_floor ? touched_for_[k] + dt : 0;
    const auto& place = finger.tactile.place_L;
    if (!finger.tactile.valid || !place) continue;
    if (!place_at_start_[k]) place_at_start_[k] = place;
    moved_[k] = moved_[k] || (*place - *place_at_start_[k]).norm() > limits_.tactor_moves;
  }
  loss_time_ = feelsBoth() ? 0 : loss_time_ + dt;
  feelSlip();
}

// Stretch by stretch; the first one that begins with both fingers touching only remembers where the tactors are.
void Touch::feelSlip() {
  slips_ = false;
  if (limits_.tactor_use != TactorUse::kSlip) return;
  const bool stretch_over = percept_.time - stretch_begin_ >= limits_.reflex_time;
  if (feelsBoth() && !stretch_over) return;
  for (int i = 0; i < kHandFingers; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto& place = percept_.fingers[k].tactile.place_L;
    if (!place) continue;
    slips_ = slips_ || (feelsBoth() && (*place - place_before_[k]).norm() > limits_.tactor_moves);
    place_before_[k] = *place;
  }
  stretch_begin_ = percept_.time;
}

Vec3 Touch::padAxis_W(int finger, const Vec3& axis_F) const {
  const auto k = static_cast<std::size_t>(finger);
  const Quat q_DF = percept_.fingers[k].arm.q_DF.value_or(Quat::Identity());
  return sense_.q_felt_true[k] * (cues_.fingers[k].q_WD * (q_DF * axis_F));
}

std::optional<int> Touch::pushedFromBelow(Random& random) {
  std::optional<int> from_below;
  for (int i = 0; i < kHandFingers; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (touched_for_[k] < limits_.reflex_time) continue;
    touched_for_[k] = limits_.reflex_time - limits_.reading_time;
    const Vec3 felt_W = drawRotation(limits_.direction_sd, random) * push_W_[k];
    if (felt_W.z() > -felt_W.dot(padAxis_W(i, cues_.fingers[k].pad_normal_F))) from_below = i;
  }
  return from_below;
}

Vec3 Touch::feltTip_W(int finger) const {
  const auto k = static_cast<std::size_t>(finger);
  const FingerCue& cue = cues_.fingers[k];
  return cue.q_WD * percept_.fingers[k].arm.p_DF + cue.p_WD - sense_.misplacement_W[k];
}

std::optional<Vec3> Touch::readPlace(Random& random) const {
  const auto first = readPlace(0, random);
  const auto second = readPlace(1, random);
  if (!first || !second) return std::nullopt;
  return Vec3(0.5 * (*first + *second));
}

// The noise is drawn in any case: that of later readings doesn't depend on the condition.
std::optional<Vec2> Touch::readPad(int finger, Random& random) const {
  const auto k = static_cast<std::size_t>(finger);
  const Vec2 noise = limits_.tactor_sd * random.normal2();
  const auto& place = percept_.fingers[k].tactile.place_L;
  if (limits_.tactor_use != TactorUse::kPlace || !moved_[k] || !place) return std::nullopt;
  return Vec2(limits_.tactor_bias * *place + noise);
}

std::optional<Vec3> Touch::readPlace(int finger, Random& random) const {
  const auto felt_L = readPad(finger, random);
  if (!felt_L) return std::nullopt;
  const FingerCue& cue = cues_.fingers[static_cast<std::size_t>(finger)];
  const double length = felt_L->norm();
  if (length == 0) return Vec3::Zero().eval();
  const double along = (cue.tip_radius + cues_.half_width) * math::sin(length / cue.tip_radius) / length;
  return Vec3(along * (felt_L->x() * padAxis_W(finger, cue.distal_F) + felt_L->y() * padAxis_W(finger, cue.radial_F)));
}

std::optional<Vec3> Touch::readContact(int finger, Random& random) const {
  const auto felt_L = readPad(finger, random);
  if (!felt_L) return std::nullopt;
  const FingerCue& cue = cues_.fingers[static_cast<std::size_t>(finger)];
  const double length = felt_L->norm();
  const double angle = length / cue.tip_radius, across = length > 0 ? math::sin(angle) / length : 0;
  return Vec3(math::cos(angle) * padAxis_W(finger, cue.pad_normal_F) +
              across * (felt_L->x() * padAxis_W(finger, cue.distal_F) + felt_L->y() * padAxis_W(finger, cue.radial_F)));
}

std::optional<Vec3> Touch::readPush(int finger, Random& random) const {
  const Quat noise = drawRotation(limits_.direction_sd, random);
  const Vec3& push_W = push_W_[static_cast<std::size_t>(finger)];
  if (push_W.norm() <= limits_.force_floor) return std::nullopt;
  return Vec3(noise * push_W.normalized());
}

}  // namespace pincer::tasks
