// outward_float: single precision that never moves a bound inwards.
#pragma once
#include <cmath>
#include <limits>

namespace pincer::contact {

inline float below(double x) { return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity()); }
inline float above(double x) { return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity()); }

}  // namespace pincer::contact
