// staircase: levels that follow the answers. After `down` right answers in a row (since the last change) the level goes
// down by a step, after `up` wrong ones in a row up by one. Where the direction changes, the level is a reversal.
//
//   threshold = mean of the last `averaged` reversal levels
//   1-up n-down settles where  p^n = 1/2:  n = 2 at 70.7 %, n = 3 at 79.4 %
//
//   p  probability of a right answer at the level [-]
// Source: H. Levitt, "Transformed up-down methods in psychoacoustics", J. Acoust. Soc. Am. 49(2B), 1971, 467-477.
// That point is reached for steps that are small beside the spread of the psychometric function. With equal steps up
// and down the mean of reversals misses it by more, the larger they are (M. A. Garcia-Perez, "Forced-choice staircases
// with fixed step sizes", Vision Res. 38(12), 1998, 1861-1881), and a few reversals still remember the start. `pincer
// bench study` measures both. Departures: levels are kept within [lowest, highest]; a staircase ends after
// `most_trials` in any case, and then may have no threshold.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace pincer::tasks {

struct StaircaseRule {
  int up = 1, down = 2;           // >= 1
  double start = 1;               // in the level's unit, as all below
  double large_step = 0.1;        // until `large_reversals` have been
  double small_step = 0.02;       // from then on
  bool steps_are_ratios = false;  // the level is multiplied or divided by 1 + step
  int large_reversals = 3;
  int reversals = 11;  // then it is over
  int averaged = 6;    // of them, the last ones
  double lowest = 0, highest = std::numeric_limits<double>::infinity();
  int most_trials = 400;
};

// The mistake in the rule, as a sentence with field, value and range; empty if there is none.
std::string problemWith(const StaircaseRule& rule);

// The probability of a right answer at which a 1-up n-down staircase settles.
double convergencePoint(int down);

class Staircase {
 public:
  explicit Staircase(const StaircaseRule& rule) : rule_(rule), level_(rule.start) {}

  double level() const { return level_; }  // to be shown next
  bool over() const;
  // Takes the answer at level(); returns whether that level was a reversal.
  bool answer(bool correct);

  int trials() const { return trials_; }
  const std::vector<double>& reversals() const { return reversals_; }
  double threshold() const;  // NaN before `averaged` reversals
  double progress() const;   // share of the reversals that have been [-]

 private:
  bool move(int direction);

  StaircaseRule rule_;
  double level_;
  int right_ = 0, wrong_ = 0;  // in a row, since the last change
  int direction_ = 0;          // of the last change: -1 down, +1 up, 0 none yet
  int trials_ = 0;
  std::vector<double> reversals_;
};

}  // namespace pincer::tasks
