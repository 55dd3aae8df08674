// flat_belief: what a hand that pinches an upright cylinder knows about its flat, and about where its own fingers are.
//
//   hypothesis    theta, direction of the flat; a, b: what both fingertips, and one against the other, are beside where they feel
//   fingertip i   c_i = f_i + a -+ b/2,  f_i felt, c_i true, from the axis [m, horizontal]
//   likelihood    N(dist(c_i; theta) - r + pressed; span_sd) N(felt push - normal(c_i; theta); push_sd) N(felt place - normal; place_sd), i = 1, 2
//
// dist and normal: of the circle of radius R whose part beyond d is cut off, from outside. A bootstrap particle filter: N. J. Gordon,
// D. J. Salmond, A. F. M. Smith, "Novel approach to nonlinear/non-Gaussian Bayesian state estimation", IEE Proc. F 140(2), 1993, 107-113;
// resampled systematically when the effective number of hypotheses is under half of them, with a little noise on the copies.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "devices/math.h"
#include "tasks/participants/random.h"

namespace pincer::tasks {

struct FlatModel {
  double radius = 0.02, flat_distance = 0.0141, tip_radius = 8e-3;  // [m]
  double placement_sd = 7e-3, placement_between_sd = 4e-3;          // of a and b, per axis [m]
  double span_sd = 1.06e-3;                                         // [m]
  double push_sd = 0.47;   // 20 degrees of a felt direction, 18 of friction: a cone of 31 degrees, evenly filled [rad]
  double place_sd = 0.21;  // 1.63 mm on a pad of 8 mm, 3 degrees of the finger [rad]
  double place_gain = 0.9;
};

// What one finger told in a pinch. Directions about W's z axis [rad], of the surface's outward normal.
struct FlatPercept {
  Vec2 p_felt = Vec2::Zero();   // fingertip's centre from where the axis is told to be [m]
  double pressed = 0;           // how deep the fingertip is in the surface, which gives way [m]
  double pad = 0;               // from the fingertip's middle against its pad: the normal that a touch in the pad's middle means [rad]
  std::optional<double> push;   // of the felt push
  std::optional<double> place;  // of the felt contact place
};

class FlatBelief {
 public:
  void begin(const FlatModel& model, Random& random);
  void observe(const std::array<FlatPercept, 2>& pinch, Random& random);
  // The cylinder was turned by `angle`, known to `sd` [rad].
  void turned(double angle, double sd, Random& random);

  double direction() const;  // circular mean [rad]
  double spread() const;     // circular standard deviation [rad]
  Vec2 axis() const;         // where the axis is felt to be [m]

 private:
  struct Hypothesis {
    double theta = 0;
    Vec2 a = Vec2::Zero(), b = Vec2::Zero();
    double weight = 1;
  };
  static constexpr std::size_t kHypotheses = 600;

  double logLikelihood(const Hypothesis& h, const std::array<FlatPercept, 2>& pinch) const;
  void resample(Random& random);
  Vec2 resultant() const;

  FlatModel model_;
  std::vector<Hypothesis> hypotheses_, copies_;
  std::vector<double> logs_;
};

// Distance from the cut circle to a point outside of it, and the direction of its normal there [rad]. `c` from the axis [m].
struct CutCircle {
  double distance = 0, normal = 0;
};
CutCircle cutCircle(const FlatModel& model, double theta, const Vec2& c);

}  // namespace pincer::tasks
