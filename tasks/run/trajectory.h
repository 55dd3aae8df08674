// trajectory: where a finger's device is at every moment of a scene.
//
// Between two keyframes the minimum-jerk reach, at rest at both ends; s = (t - t0)/(t1 - t0):
//   p = p0 + (p1 - p0) (10 s^3 - 15 s^4 + 6 s^5),   v = (p1 - p0)/(t1 - t0) (30 s^2 - 60 s^3 + 30 s^4)
// Source: T. Flash, N. Hogan, J. Neurosci. 5(7) (1985) 1688-1703, eq. (4).
// Between two samples of a recorded motion the cubic that takes up each sample's velocity, which is the slope there of
// the parabola through it and its two neighbours (at the ends: through the two neighbours only, a straight slope).
// Source: C. de Boor, A Practical Guide to Splines, 1978, ch. IV (Bessel interpolation; departure: the straight slope
// at the ends). Before the first point and after the last the finger rests there.
#pragma once
#include <string>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/math.h"

namespace pincer::tasks {

struct TimedPoint {
  double time = 0;          // [s]
  Vec3 p_W = Vec3::Zero();  // [m]
  Vec3 v_W = Vec3::Zero();  // [m/s]; zero at keyframes
};

class Trajectory {
 public:
  Trajectory() = default;
  // Points need strictly increasing times (problemBetween says more); a single one is a finger at rest.
  static Trajectory throughKeyframes(std::vector<TimedPoint> keyframes);
  static Trajectory throughSamples(std::vector<TimedPoint> samples);

  TimedPoint at(double time) const;  // any finite time
  Vec3 start() const { return points_.front().p_W; }
  double end() const { return points_.back().time; }

 private:
  std::vector<TimedPoint> points_{TimedPoint{}};
  bool minimum_jerk_ = true;
};

// Says why nothing can go from one point to the next: it doesn't come later, or would go faster than `fastest` [m/s or
// rad/s], or is out of the range of places or times. Empty if all is well.
std::string problemBetween(const TimedPoint& from, const TimedPoint& to, double fastest);

// Reads rows `time,x,y,z` [s, m] under exactly that header. Throws InputError naming file, line and value.
Trajectory readTrajectoryCsv(const std::string& path);

}  // namespace pincer::tasks
