// constants: what several tests share; SI units.
#pragma once
#include <limits>
#include <numbers>

namespace pincer::tests {

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kGravity = 9.81;     // [m/s^2]
constexpr double kFinger = 0.008;     // [m] radius of a fingertip
constexpr double kMargin = 0.001;     // [m] what the engine asks with
constexpr double kRoundOff = 1e-15;   // a few ulp of the numbers of size 0.1 to 1 that the tests look at
constexpr double kCreaseAngle = 0.7;  // [rad] 40 degrees

}  // namespace pincer::tests
