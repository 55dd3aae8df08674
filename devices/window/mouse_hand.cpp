#include "pincer/devices/window/mouse_hand.h"

#include <algorithm>
#include <stdexcept>

namespace pincer::devices {

MouseHand::MouseHand(const std::vector<MouseMount>& mounts, const MouseHandSettings& settings)
    : settings_(settings), mounts_(mounts) {
  if (mounts.empty() || mounts.size() > 2)
    throw std::invalid_argument("a mouse moves one or two fingers, not " + std::to_string(mounts.size()));
  for (const MouseMount& mount : mounts) {
    MouseArmSettings arm;
    arm.serial = std::to_string(arms_.size());
    arm.start_D = mount.q_HD.conjugate() * (mount.start_H - mount.p_HD);
    arm.q_DF = mount.q_DF;
    arms_.emplace_back(arm);
  }
  home_H_ = middle_H_ = 0.5 * (mounts.front().start_H + mounts.back().start_H);
  gap_ = open_gap_ = mounts.back().start_H.x() - mounts.front().start_H.x();
  wanted_ = {middle_H_, false, settings.grip, 0};
  publish();
}

void MouseHand::publish() {
  wishes_.writable() = wanted_;
  wishes_.publish();
}
void MouseHand::move(const Vec3& by_H) {
  wanted_.middle_H += by_H;
  publish();
}
void MouseHand::turn(double by) {
  wanted_.turn = std::clamp(wanted_.turn + by, -settings_.most_turn, settings_.most_turn);
  publish();
}
void MouseHand::squeeze(bool on) {
  wanted_.squeezes = on;
  publish();
}
void MouseHand::changeGrip(double factor) {
  wanted_.grip = std::clamp(wanted_.grip * factor, settings_.least_grip, settings_.most_grip);
  publish();
}

Vec3 MouseHand::place_H(int finger) const {
  const auto i = static_cast<std::size_t>(finger);
  return mounts_[i].p_HD + mounts_[i].q_HD * arms_[i].place_D();
}
Vec3 MouseHand::velocity_H(int finger) {
  const auto i = static_cast<std::size_t>(finger);
  return mounts_[i].q_HD * *arms_[i].sample().v_DF;
}
void MouseHand::commandForce_H(int finger, const Vec3& f_H) {
  const auto i = static_cast<std::size_t>(finger);
  arms_[i].commandForce(mounts_[i].q_HD.conjugate() * f_H);
}

// The sign of the gap tells which finger is on the right.
double MouseHand::wantedGap(double dt, bool squeezes, double grip) const {
  const double side = open_gap_ < 0 ? -1 : 1, step = settings_.close_speed * dt;
  const double gap = side * gap_, open = side * open_gap_;
  if (!squeezes) return side * std::min(gap + step, open);
  const double apart = side * across_H().dot(place_H(1) - place_H(0));
  return side * std::max({gap - step, apart - 2 * grip / arms_[0].stiffness(), 0.0});
}

void MouseHand::advance(double dt) {
  wishes_.update();
  const Wish& wish = wishes_.current();
  const Vec3 way = (going_home_ ? home_H_ : wish.middle_H) - middle_H_;
  middle_H_ += way * std::min(1.0, settings_.top_speed * dt / std::max(way.norm(), 1e-12));
  const double turn = (going_home_ ? 0 : wish.turn) - turn_, most_turn = settings_.turn_speed * dt;
  turn_ += std::clamp(turn, -most_turn, most_turn);
  if (arms_.size() == 2) gap_ = wantedGap(dt, squeezing(), wish.grip);
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    const double side = arms_.size() == 1 ? 0 : (i == 0 ? -0.5 : 0.5);
    const Vec3 hand_H = middle_H_ + side * gap_ * across_H();
    if (mounts_[i].q_DF && turn_ != 0) {
      const Quat q_turn(math::cos(0.5 * turn_), 0, 0, math::sin(0.5 * turn_));
      arms_[i].setOrientation(mounts_[i].q_HD.conjugate() * q_turn * mounts_[i].q_HD * *mounts_[i].q_DF);
    }
    arms_[i].setHand(mounts_[i].q_HD.conjugate() * (hand_H - mounts_[i].p_HD));
    arms_[i].advance(dt);
  }
}

}  // namespace pincer::devices
