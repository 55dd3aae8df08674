// elementary: the functions of analysis with the same bits on every processor, compiler and C library.
//
// The C library's sin, exp, pow .. choose instructions by the processor at run time, and round differently with
// them. These are plain IEEE 754 arithmetic: additions, multiplications, divisions and square roots in a fixed
// order, without fused multiply-add. Errors: at most 1 unit in the last place (ulp) of the exact result, erfc 2
// ulp; tests/unit/contact/functions measure them. Special values (NaN, infinities, signed zeros,
// arguments out of range) are those of the C standard's annex F. errno isn't set, and no function depends on
// the rounding mode other than to nearest.
//
// All that is below contact/ and devices/: this room names no geometry and no device, and both may see it.
// docs/decisions/0019-own-elementary-functions.md says why they are our own.
#pragma once

namespace pincer::math {

struct SinCos {
  double sin, cos;
};

// Angles in radians, of any size: reduced by as many digits of pi as they need.
[[gnu::const]] double sin(double angle);
[[gnu::const]] double cos(double angle);
[[gnu::const]] double tan(double angle);
[[gnu::const]] SinCos sinCos(double angle);  // the bits of sin and cos, for little more than one of them

[[gnu::const]] double asin(double x);
[[gnu::const]] double acos(double x);
[[gnu::const]] double atan(double x);
[[gnu::const]] double atan2(double y, double x);

[[gnu::const]] double exp(double x);
[[gnu::const]] double exp2(double x);
[[gnu::const]] double expm1(double x);
[[gnu::const]] double log(double x);
[[gnu::const]] double log2(double x);
[[gnu::const]] double log10(double x);
[[gnu::const]] double log1p(double x);
[[gnu::const]] double pow(double x, double y);
constexpr double cube(double x) { return x * x * x; }

[[gnu::const]] double hypot(double x, double y);
[[gnu::const]] double cbrt(double x);

[[gnu::const]] double erfc(double x);

}  // namespace pincer::math
