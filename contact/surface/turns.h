// turns: which of many places is looked at now, so that each is looked at once within a given way, and few at a time.
//
//   a place has its turn where   gone / period   passes   i + phase,   i any whole number
//   phase = frac(place / golden ratio)
//
//   gone  the way that has been gone so far, period  within which each has one turn [m]
//
// The phases of places that follow each other are spread evenly over the period. A
// function of the way alone: nothing is kept.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pincer/contact/assert.h"

namespace pincer::contact {

class Turns {
 public:
  // Turns on the way from `from` to `to` >= `from` >= 0 [m]; a period of 0: everyone's.
  Turns(double from, double to, double period) : period_(period) {
    PINCER_ASSERT(!(from < 0) && !(to < from));  // what isn't finite is handed on
    if (!(period > 0)) return;
    begin_ = from / period - std::floor(from / period);
    end_ = begin_ + (to - from) / period;
  }

  bool isOf(std::int32_t place) const { return areAll() || next(place, begin_) <= end_; }
  // The way to the place's first turn after `from`, from there on, and after `to`, from there on [m], rounded down.
  double wayToFirst(std::int32_t place) const { return wayFrom(begin_, place); }
  double wayToNext(std::int32_t place) const { return wayFrom(end_, place); }

 private:
  static constexpr double kRounding = 1e-6;  // of a period

  bool areAll() const { return !(end_ - begin_ < 1); }
  double wayFrom(double from, std::int32_t place) const {
    return areAll() ? 0 : std::max(0.0, period_ * (next(place, from) - from - kRounding));
  }
  // Where after `from`, which is in [0, 2).
  static double next(std::int32_t place, double from) {
    constexpr std::uint32_t kGolden = 2654435769;  // 2^32 over the golden ratio
    const double phase = 0x1p-32 * (kGolden * static_cast<std::uint32_t>(place));
    return phase > from ? phase : phase + 1 > from ? phase + 1 : phase + 2;
  }

  double period_;
  double begin_ = 0, end_ = 1;  // in periods
};

}  // namespace pincer::contact
