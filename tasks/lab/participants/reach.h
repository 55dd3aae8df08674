// reach: a straight movement of minimum jerk between two postures of a pinching hand.
//
//   x(t) = a + (b - a) s(t/T),   s(x) = 10 x^3 - 15 x^4 + 6 x^5
//
// Source: T. Flash, N. Hogan, "The coordination of arm movements", J. Neurosci. 5(7), 1985, eq. 1.
// Mean speed |b - a|/T, peak 1.875 times it.
#pragma once
#include <algorithm>
#include <cmath>

#include "pincer/devices/math.h"

namespace pincer::tasks {

// Two fingertips at centre_W -+ half along the pinch axis.
struct Posture {
  Vec3 centre_W = Vec3::Zero();  // [m]
  double half = 0;               // half the distance of the fingertips' centres [m]
  double angle = 0;              // of the pinch axis about W's z axis from where it is told to be [rad]
};

// s above, 0 before its time and 1 after it.
inline double minimumJerk(double time, double duration) {
  const double x = duration > 0 ? std::clamp(time / duration, 0.0, 1.0) : 1;
  return x * x * x * (10 + x * (6 * x - 15));
}

struct Reach {
  Posture from, to;
  double start = 0;     // [s]
  double duration = 0;  // [s], >= 0

  Posture at(double time) const {
    const double s = minimumJerk(time - start, duration);
    return {from.centre_W + s * (to.centre_W - from.centre_W), from.half + s * (to.half - from.half),
            from.angle + s * (to.angle - from.angle)};
  }
  bool over(double time) const { return time >= start + duration; }
};

// The movement at mean speed `speed` > 0 [m/s] of the finger that has further to go.
inline Reach reach(const Posture& from, const Posture& to, double start, double speed) {
  const double distance = (to.centre_W - from.centre_W).norm() + std::abs(to.half - from.half) +
                          std::max(from.half, to.half) * std::abs(to.angle - from.angle);
  return {from, to, start, distance / speed};
}

}  // namespace pincer::tasks
