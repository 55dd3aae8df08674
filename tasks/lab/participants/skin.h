// skin: what the fingertip's skin makes of small quick motions, and how little of them is felt.
//
// The arm's push reaches the skin through the arm's own mass, which rests on the skin as on a
// spring; a tactor moves the skin directly:
//
//   push    u'' = w^2 (f / k - u) - 2 zeta w u',   w^2 = k / m         tactor   u = place
//   band    u -> high-pass at f1, three times -> low-pass at f2;   a = root mean square of the band over the reading
//   felt    a + sigma n,   sigma = sqrt(a0^2 + (c a)^2) / 0.954,   n standard normal, one per reading
//
//   u      motion of the skin [m];  f  push [N]
//   k, m, zeta  stiffness [N/m], arm's apparent mass [kg], damping ratio
//   a0, c  absolute and difference threshold, each of 75 % right answers in two intervals: there a difference of
//          0.674 sqrt(2) sigma = 0.954 sigma is felt.
// Sources of the limits, from memory and to be checked against the papers: absolute thresholds of the non-Pacinian and
// Pacinian channels, S. J. Bolanowski, G. A. Gescheider, R. T. Verrillo, C. M. Checkosky, J. Acoust. Soc. Am. 84(5),
// 1988 (rounded); difference threshold, J. C. Craig, J. Exp. Psychol. 95(1), 1972 (0.2). The high-pass is of third
// order (choice): of a stroke's own motion, millimetres at half a hertz, one of first order leaves 0.1, one of third
// 0.001 in the slow band, less than the threshold. What is marked (choice) is ours.
#pragma once
#include <array>

#include "pincer/devices/math.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct SkinLimits {
  double stiffness = 1000;       // of the fingerpad under a thimble [N/m] (choice)
  double mass = 0.1;             // apparent, of arm and display [kg] (choice: the arm's own 30-150 g)
  double damping = 0.5;          // zeta [-] (choice)
  double slow_threshold = 7e-6;  // a0 of the band 5 .. 50 Hz, root mean square [m]: 10 um peak (Bolanowski et al. 1988)
  // a0 of the band 50 .. 300 Hz [m] (Bolanowski et al. 1988; for a small contactor: choice)
  double quick_threshold = 1e-6;
  double difference = 0.2;  // c [-] (Craig 1972)
};

// A third-order high-pass followed by a second-order low-pass, each a row of equal first-order ones, exact
// over a step of 1 ms for an input that stays.
class BandPass {
 public:
  BandPass(double low, double high);  // corner frequencies [Hz]
  double pass(double input);

 private:
  double keep_low_, keep_high_;
  std::array<double, 3> slow_{};
  double first_ = 0, second_ = 0;
  bool begun_ = false;
};

// One band of the motion of the skin along one axis.
class BandPower {
 public:
  BandPower(double low, double high) : filter_(low, high) {}
  void add(double u, bool counts);  // every millisecond [m]; `counts`: belongs to the reading
  double rms() const;               // [m], 0 of nothing
  void clear();                     // forgets the reading, not the skin

 private:
  BandPass filter_;
  double sum_ = 0;
  int count_ = 0;
};

// The skin under the arm's push.
class PushedSkin {
 public:
  explicit PushedSkin(const SkinLimits& limits);
  Vec2 pushed(const Vec2& f);  // u [m] after a millisecond of push f [N], tangential and normal

 private:
  double stiffness_, w2_, drag_;
  Vec2 u_ = Vec2::Zero(), v_ = Vec2::Zero();
};

// The part of a motion of amplitude `rms` that is felt.
struct FeltMotion {
  double felt = 0;   // [m]
  double sigma = 1;  // of the noise in it [m]
};
FeltMotion feltMotion(double rms, double threshold, double difference, Random& random);

}  // namespace pincer::tasks
