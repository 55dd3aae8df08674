// outward_float: single precision that never moves a bound inwards.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pincer::contact {

// The float after the one nearest to `x`: std::nextafter's, without a library's call.
inline float above(double x) {
  const auto f = static_cast<float>(x);
  if (!(f < std::numeric_limits<float>::infinity())) return f;
  if (f == 0) return std::numeric_limits<float>::denorm_min();
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(f) + (f > 0 ? 1 : -1));
}
inline float below(double x) { return -above(-x); }

}  // namespace pincer::contact
