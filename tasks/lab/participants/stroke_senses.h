// stroke_senses: what somebody who strokes a curve feels of the tactor's play and of its delay.
//
//   play    after a stop the finger goes back a small way w; the tactor, if it has play, lags behind:
//           lost = g (w + sigma_w n) - (d + sqrt(sigma_d^2 + (c d)^2) n'),     the mean over an interval's stops
//           w, d   own way and the tactor's [m];  n, n'  normal, one per stop
//           g      tactor's way per finger's, known from training [-]
//   delay   time between hand and tactor, the mean over an interval's strokes:
//           felt = lag + m sqrt(sigma_t^2 + (c lag)^2) n, one per interval
//           stop   from the hand's stop to the last motion of the tactor that is felt, while the finger rests; m = 1
//           onset  from the hand's start to the tactor's first motion that is felt, masked by the hand's own; m > 1
//
// Sources: sigma_w from the difference limen of short lengths between the fingers, 1.0 mm (N. I. Durlach et
// al., Percept. Psychophys. 46(1), 1989; from memory); sigma_d from 0.17 mm between successive places on a
// fingerpad (J. M. Loomis, cited in Doxon 2014, ch. 3); sigma_t from 60 ms (S. Okamoto, M. Konyo, S. Saga, S.
// Tadokoro, IEEE Trans. Haptics 2(2), 2009, 73-84); each taken as the point of 75 % right answers in two
// intervals: / 0.954. c and m are ours (choice).
#pragma once
#include <array>

#include "pincer/devices/math.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {

struct LagLimits {
  double way_sd = 1.05e-3;       // sigma_w [m]
  double place_sd = 0.178e-3;    // sigma_d [m]
  double time_sd = 0.0629;       // sigma_t [s]
  double difference = 0.15;      // c [-] (choice)
  double masking = 2;            // m of an onset [-] (choice)
  double tactor_moves = 0.2e-3;  // a tactor that has moved less is felt as still [m] (choice)
};

class PlaySense {
 public:
  explicit PlaySense(const LagLimits& limits) : limits_(limits) {}
  void clear();
  // where both are before the finger goes back [m along the path], [m on the pad]
  void stop(double finger, double tactor);
  void back(double finger, double tactor, double gain, Random& random);  // and after it
  void read(std::size_t interval) { felt_[interval] = stops_ > 0 ? sum_ / stops_ : 0; }
  int larger() const { return felt_[1] > felt_[0] ? 2 : 1; }

 private:
  LagLimits limits_;
  double finger_ = 0, tactor_ = 0, sum_ = 0;  // [m]
  int stops_ = 0;
  std::array<double, 2> felt_{};  // [m]
};

class DelaySense {
 public:
  explicit DelaySense(const LagLimits& limits) : limits_(limits) {}
  void clear();
  void handStarts(double now, double tactor);
  void handStops(double now) { stopped_ = now; }
  void feel(double now, double tactor);  // every millisecond from start to the end of the rest
  void takeStop();                       // at the end of the rest
  void takeOnset(double now);            // at the end of a stroke; an onset that wasn't felt counts as late as that
  void read(std::size_t interval, bool masked, Random& random);
  int larger() const { return felt_[1] > felt_[0] ? 2 : 1; }

 private:
  void take(double lag);

  LagLimits limits_;
  double started_ = 0, stopped_ = 0, first_ = 0, last_ = 0;  // [s]
  double mark_ = 0;                                          // of the tactor [m]
  bool moved_ = false;
  double sum_ = 0;  // [s]
  int strokes_ = 0;
  std::array<double, 2> felt_{};  // [s]
};

}  // namespace pincer::tasks
