#include "pincer/tasks/lab/participants/roughness.h"

#include <cmath>

namespace pincer::tasks {
namespace {

std::array<BandPower, 2> skinBands() {
  constexpr double kSlowLow = 5, kSlowHigh = 50, kQuickHigh = 300;  // [Hz]
  return {BandPower(kSlowLow, kSlowHigh), BandPower(kSlowHigh, kQuickHigh)};
}

}  // namespace

RoughnessSense::RoughnessSense(const SkinLimits& limits, double tactor_weight)
    : limits_(limits),
      weight_(tactor_weight),
      skin_(limits),
      along_(skinBands()),
      across_(skinBands()),
      tactor_(skinBands()) {}

void RoughnessSense::feelPush(const Vec2& f, bool counts) {
  const Vec2 u = skin_.pushed(f);
  for (BandPower& band : along_) band.add(u.x(), counts);
  for (BandPower& band : across_) band.add(u.y(), counts);
}

void RoughnessSense::feelTactor(double place, bool counts) {
  for (BandPower& band : tactor_) band.add(place, counts);
}

void RoughnessSense::clear() {
  for (auto* bands : {&along_, &across_, &tactor_}) {
    for (BandPower& band : *bands) band.clear();
  }
}

void RoughnessSense::read(std::size_t interval, Random& random) {
  for (std::size_t b = 0; b < kBands; ++b) {
    const double threshold = b == 0 ? limits_.slow_threshold : limits_.quick_threshold;
    const FeltMotion push =
        feltMotion(math::hypot(along_[b].rms(), across_[b].rms()), threshold, limits_.difference, random);
    const FeltMotion tactor = feltMotion(tactor_[b].rms(), threshold, limits_.difference, random);
    const double w = tactor_[b].rms() > 0 ? weight_ : 0;
    readings_[interval][b] = {(1 - w) * push.felt + w * tactor.felt,
                              math::hypot((1 - w) * push.sigma, w * tactor.sigma)};
  }
}

int RoughnessSense::rougher() const {
  double sum = 0;
  for (std::size_t b = 0; b < kBands; ++b) {
    const Percept &first = readings_[0][b], &second = readings_[1][b];
    sum += (second.roughness - first.roughness) / math::hypot(first.sigma, second.sigma);
  }
  return sum > 0 ? 2 : 1;
}

}  // namespace pincer::tasks
