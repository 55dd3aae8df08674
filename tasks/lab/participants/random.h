// random: a small seeded generator with the same bits on every compiler and standard library
// (std::normal_distribution's bits are not).
//
//   bits     xoshiro256++ (D. Blackman, S. Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47(4),
//            2021), its state filled from the seed by splitmix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014)
//   uniform  the upper 53 bits, times 2^-53
//   normal   sqrt(-2 ln u1) cos(2 pi u2), u1 in (0, 1]  (G. Box, M. Muller, Ann. Math. Stat. 29(2), 1958)
//            the sine branch is dropped, so that a draw has no hidden half
#pragma once
#include <array>
#include <cstdint>

#include "pincer/devices/math.h"

namespace pincer::tasks {

// A seed for a part of something that has a seed itself: different parts give unrelated streams.
std::uint64_t seedFor(std::uint64_t seed, std::uint64_t part);

class Random {
 public:
  explicit Random(std::uint64_t seed);

  std::uint64_t bits();
  double uniform();                         // [0, 1)
  double uniform(double low, double high);  // [low, high)
  double normal();                          // mean 0, standard deviation 1
  Vec2 normal2();                           // independent components
  Vec3 normal3();
  std::uint64_t below(std::uint64_t bound);  // 0 .. bound - 1, each equally likely; bound > 0

 private:
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace pincer::tasks
