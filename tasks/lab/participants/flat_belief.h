// flat_belief: what a hand that pinches an upright cylinder knows about its flat, and about where its own fingers are.
//
//   hypothesis    theta, direction of the flat; a, b: what both fingertips, and one
//                 against the other, are beside where they feel
//   fingertip i   c_i = f_i + a -+ b/2,  f_i felt, c_i true, from the axis [m, horizontal]
//   likelihood    N(dist(c_i; theta) - r + pressed; span_sd) N(felt push - normal(c_i; theta); push_sd)
//                 N(felt place - normal; place_sd), i = 1, 2
//
// dist and normal: of the circle of radius R whose part beyond d is cut off, from outside.
//
// The distances are sharp (1 mm where the hand is 7 mm off), so hypotheses drawn blindly would nearly all be wrong:
// with as many as can be afforded a bootstrap filter is sure of directions that are 60 degrees off. Each hypothesis is
// therefore a direction with a Gaussian over x = (a, b), whose mean is drawn from a part of the prior and whose
// covariance is the rest, updated by the extended Kalman filter; its weight takes the likelihood of each innovation.
// Source: J. H. Kotecha, P. M. Djuric, "Gaussian sum particle filtering", IEEE Trans. Signal Process. 51(10), 2003,
// 2602-2612; weighing and resampling: weighing.h. Directions begin evenly spaced.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "pincer/devices/math.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct FlatModel {
  double radius = 0.02, flat_distance = 0.0141, tip_radius = 8e-3;  // [m]
  double placement_sd = 7e-3, placement_between_sd = 4e-3;          // of a and b, per axis [m]
  double span_sd = 1.06e-3;                                         // [m]
  double push_sd = 0.47;   // 20 degrees of a felt direction, 18 of friction: a cone of 31 degrees, evenly filled [rad]
  double place_sd = 0.21;  // 1.63 mm on a pad of 8 mm, 3 degrees of the finger [rad]
  double place_gain = 0.9;
};

// One finger's news in a pinch. Directions about W's z axis [rad], of the surface's outward normal.
struct FlatPercept {
  Vec2 p_felt = Vec2::Zero();  // fingertip's centre from where the axis is told to be [m]
  double pressed = 0;          // how deep the fingertip is in the surface, which gives way [m]
  // from the fingertip's middle against its pad: the normal that a touch in the pad's middle means [rad]
  double pad = 0;
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
  using Vec4 = Eigen::Vector4d;
  using Mat4 = Eigen::Matrix4d;
  struct Hypothesis {
    double theta = 0;
    Vec4 x = Vec4::Zero();  // (a, b)
    Mat4 P = Mat4::Zero();  // covariance of x
    double weight = 1;
  };
  static constexpr std::size_t kHypotheses = 1200;  // 0.3 degrees between two directions at the start; chosen

  double update(Hypothesis& h, const std::array<FlatPercept, 2>& pinch) const;
  double update(Hypothesis& h, const FlatPercept& percept, double half) const;
  Vec2 resultant() const;

  FlatModel model_;
  std::vector<Hypothesis> hypotheses_, copies_;
  std::vector<double> logs_;
};

// Distance from the cut circle to a point outside of it, the direction of its normal there [rad], and how fast that
// turns when the point moves along the surface [rad/m]. `c` from the axis [m].
struct CutCircle {
  double distance = 0, normal = 0, bend = 0;
};
CutCircle cutCircle(const FlatModel& model, double theta, const Vec2& c);

}  // namespace pincer::tasks
