// place_belief: what a hand that pinches a round object knows about where it pinches, and how slippery the object is.
//
//   hypothesis  o, offset of the object's centre from the middle of the
//               fingertips, across the pinch [m]; mu, friction [-]
//   holds       Phi((atan mu - asin(|o|/L))/0.1) Phi((2 mu g/W - 1)/0.15)
//               L = tip radius + half width [m], g  grip, W  weight [N]
//   place read  N(p - gain o; place_sd) per axis: the pads' tactors
//   push read   N(t + o/|o| max(0, asin(|o|/L) - atan mu); push_sd) per axis: t, the mean push's tilt from
//               the pinch line. Inside the friction cone the push lies along the line of the contacts
//               whatever the offset is, and tells nothing
//   failed      1 - holds
//   let go      o_1 += N(0; rolls_sd): the object rolls in its dish before it is pinched again
//   height      o_2 = N(0; height_sd): a finger stood on the dish, and the pinch was put
//               to where the object's middle is above it
//
// Bootstrap particle filter (weighing.h). The two softnesses, 0.1 rad and 0.15, are ours.
#pragma once
#include <vector>

#include "pincer/devices/math.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct PlaceModel {
  double lever = 0.028;                        // L [m]
  double weight = 0.736;                       // W [N]
  double placement_sd = 7e-3;                  // of o, per axis [m]
  double mu_min = 0.25, mu_max = 1.0;          // evenly in the logarithm: what training has shown
  double place_sd = 4.2e-3, place_gain = 0.9;  // [m], [-]
  double push_sd = 0.25;                       // [rad]
  double rolls_sd = 5e-3, height_sd = 4e-3;    // [m]
};

class PlaceBelief {
 public:
  void begin(const PlaceModel& model, Random& random);
  void placeRead(const Vec2& place, Random& random);
  void pushRead(const Vec2& tilt, Random& random);
  void failed(double grip, Random& random);
  void moved(const Vec2& shift);  // of the fingertips
  void letGo(Random& random);
  void heightFound(Random& random);

  Vec2 offset() const;                                 // mean of o [m]
  double holds(const Vec2& shift, double grip) const;  // expected, after a shift
  // of the mean, and of some hypotheses, the one that holds best
  Vec2 bestShift(double grip, double farthest, Random& random) const;

 private:
  struct Hypothesis {
    Vec2 o = Vec2::Zero();
    double mu = 0.5, weight = 1;
  };
  static constexpr std::size_t kHypotheses = 300;  // for three numbers, o and mu; chosen

  double holds(const Hypothesis& h, const Vec2& shift, double grip) const;
  template <class LogLikelihood>
  void update(LogLikelihood logLikelihood, Random& random);

  PlaceModel model_;
  std::vector<Hypothesis> hypotheses_, copies_;
  std::vector<double> logs_;
};

}  // namespace pincer::tasks
