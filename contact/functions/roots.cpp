// hypot and cbrt: the residual of a good guess, with all its digits, corrects it once.
#include <cmath>
#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"

namespace pincer::math {

double hypot(double x, double y) {
  // Infinite even where the other is no number (IEEE 754).
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const double a = magnitude(x), b = magnitude(y);
  if (a == kInfinite || b == kInfinite) return kInfinite;
  if (a != a || b != b) return a + b;
  const double large = a < b ? b : a, small = a < b ? a : b;
  if (small == 0) return large;
  const Significand s = significandOf(large), t = significandOf(small);
  if (s.exponent - t.exponent > 60) return large;
  const double u = s.m, v = scaled(t.m, t.exponent - s.exponent);
  const DoubleDouble sum = exactProduct(u, u) + exactProduct(v, v);
  const double root = std::sqrt(sum.hi);
  const DoubleDouble square = exactProduct(root, root);
  return scaled(root + (((sum.hi - square.hi) - square.lo) + sum.lo) / (2 * root), s.exponent);
}

double cbrt(double x) {
  const double size = magnitude(x);
  if (size == 0 || !(size < std::numeric_limits<double>::infinity())) return x;
  const Significand s = significandOf(size);
  const int thirds = (s.exponent + 3 * 400) / 3 - 400, left = s.exponent - 3 * thirds;
  const double m = s.m * powerOfTwo(left);      // 1 .. 8
  double y = 0.75 + m * (0.2525 - m * 0.0125);  // within 4 % there
  for (int i = 0; i < 2; ++i) {                 // Halley: errors e -> 2/3 e^3
    const double yyy = y * y * y;
    y *= (yyy + 2 * m) / (2 * yyy + m);
  }
  const DoubleDouble square = exactProduct(y, y), p = exactProduct(square.hi, y);
  const double residual = ((m - p.hi) - p.lo) - square.lo * y;
  return withSignOf(scaled(y + residual / (3 * square.hi), thirds), x);
}

}  // namespace pincer::math
