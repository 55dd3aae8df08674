#include "pincer/tasks/lab/experiments/hand_hints.h"

#include <cmath>
#include <numbers>

namespace pincer::tasks {
namespace {

// Of the half width. A pinch so far in front of the middle or behind it makes an angle of 14 degrees, which the most
// slippery sphere just allows (17); to the side, the finger that touches first pushes.
constexpr double kAside = 0.25, kAlong = 0.5;
constexpr double kFarthestTurn = 1.1;  // of a hand, near the end of its way (devices/window/mouse_hand.h: 1.2) [rad]
constexpr double kTurnedBack = 0.2;    // from there, before it is worth to squeeze again [rad]

}  // namespace

const char* reachHint(const HandPlaces& p) {
  const Vec3 way = p.middle_W - 0.5 * (p.index_W + p.thumb_W);
  const double apart = (p.thumb_W - p.index_W).head<2>().norm();
  if (apart < 2 * p.half_width) return "Let go: the fingers are closed, and not around the object";
  if (way.y() > kAside * p.half_width) return "It is farther away: Shift and the mouse upwards, or Page up";
  if (way.y() < -kAside * p.half_width) return "It is nearer to you: Shift and the mouse downwards, or Page down";
  if (way.x() > kAlong * p.half_width) return "It is on the right: move there";
  if (way.x() < -kAlong * p.half_width) return "It is on the left: move there";
  return -way.z() > p.reach_up ? "Lower the fingers beside the object" : "";
}

double handTurn(const HandPlaces& p) {
  const Vec3 line = p.thumb_W - p.index_W;
  const double angle = math::atan2(line.y(), line.x());
  return angle - std::numbers::pi * std::round(angle / std::numbers::pi);
}

const char* turnHint(double hand_turn, double needed, bool pinches) {
  const bool left = needed > 0;
  const double turned = left ? hand_turn : -hand_turn;  // in the way that is needed
  if (pinches && turned > kFarthestTurn)
    return left ? "So far the hand goes: let go, turn it back with E, squeeze again"
                : "So far the hand goes: let go, turn it back with Q, squeeze again";
  if (pinches)
    return left ? "Turn to the left: Q, or Control and the mouse" : "Turn to the right: E, or Control and the mouse";
  if (turned > kTurnedBack) return left ? "Turn the hand back to the right: E" : "Turn the hand back to the left: Q";
  return "Squeeze: hold the left button, or G";
}

}  // namespace pincer::tasks
