// roughness: how rough a curve felt under one finger, as one percept of two senses.
//
//   a_sb      root mean square of what is felt of the skin's motion by sense s (push, tactor) in band
//             b (slow, quick), with its noise (skin.h)
//   r_b   =   (1 - w) a_push,b + w a_tactor,b,      s_b^2 = (1 - w)^2 sigma_push,b^2 + w^2 sigma_tactor,b^2
//   rougher:  the interval in which r is larger, by the sign of   sum_b (r_b(2) - r_b(1)) / sqrt(s_b(1)^2 + s_b(2)^2)
//
//   w  weight of touch [-]; of a parked tactor, which tells nothing, 0
// One percept, not the better of two independent senses: the tactor rests on the very skin that feels the
// push. That w is the same whatever is shown is ours, and so is its size (choice); it decides how far
// touch outweighs force (docs/experiments.md).
#pragma once
#include <array>

#include "pincer/tasks/lab/participants/skin.h"

namespace pincer::tasks {

class RoughnessSense {
 public:
  RoughnessSense(const SkinLimits& limits, double tactor_weight);

  // Every millisecond: the push on the finger along and across the path [N]; `counts`: belongs to the reading.
  void feelPush(const Vec2& f, bool counts);
  void feelTactor(double place, bool counts);  // [m]; not called while the tactor tells no place
  void clear();                                // forgets the reading, not the skin
  void read(std::size_t interval, Random& random);
  int rougher() const;  // 1 or 2; after both have been read

 private:
  static constexpr std::size_t kBands = 2;  // slow, quick
  struct Percept {
    double roughness = 0, sigma = 1;  // r, s [m]
  };

  SkinLimits limits_;
  double weight_;
  PushedSkin skin_;
  std::array<BandPower, kBands> along_, across_, tactor_;
  std::array<std::array<Percept, kBands>, 2> readings_;
};

}  // namespace pincer::tasks
