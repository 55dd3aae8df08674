// atan, atan2, asin, acos.
//
//   atan(y/x) = atan c + atan((y - c x) / (x + c y)),   c the multiple of 1/32 nearest to y/x,   0 <= y <= x
//
// atan c from a table; the rest is at most 1/64 and has a power series. Ratios
// under 1/5 go into a longer series themselves.
#include <array>
#include <cmath>
#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"

namespace pincer::math {
namespace {

// The answer of asin and acos beyond +-1.
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr int kParts = 32, kFirst = 7;  // from 7/32 on by the table

// atan(j/32), summed up by   atan(j/32) - atan((j-1)/32) = atan(32 / (1024 + j (j-1)))
constexpr auto kArcs = [] {
  std::array<DoubleDouble, kParts + 1> arcs{};
  for (int j = 1; j <= kParts; ++j) {
    const DoubleDouble z = DoubleDouble{kParts} / DoubleDouble{1.0 * kParts * kParts + j * (j - 1)}, zz = z * z;
    DoubleDouble power = z, sum = z;
    for (int n = 3; n < 26; n += 2) {
      power = -power * zz;
      sum = sum + power / n;
    }
    arcs[static_cast<std::size_t>(j)] = arcs[static_cast<std::size_t>(j - 1)] + sum;
  }
  return arcs;
}();

// Terms after the first, of ratios up to 13/64 and of t up to 1/64: the next would be below 2^-64 and 2^-63 of it.
constexpr double kSeries[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7,  1.0 / 9,  -1.0 / 11, 1.0 / 13,
                              -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23, 1.0 / 25};
constexpr double kShortSeries[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9};

// atan(y/x), 0 <= y <= x, both of ordinary size.
DoubleDouble arcBelowOne(const DoubleDouble& y, const DoubleDouble& x) {
  const double ratio = y.hi / x.hi;
  const Nearest j = nearest(ratio * kParts);
  if (j.whole < kFirst) {
    const DoubleDouble p = exactProduct(ratio, x.hi);
    const double beyond = (((y.hi - p.hi) - p.lo) + (y.lo - ratio * x.lo)) / x.hi, z = ratio * ratio;
    return sumOfOrdered(ratio, beyond + ratio * (z * polynomial(kSeries, z)));
  }
  const double c = j.value / kParts, x1 = std::bit_cast<double>(bitsOf(x.hi) & ~std::uint64_t{0xffffffff}),
               x2 = x.hi - x1;
  // c of 5 bits, y within 8 % of c x: the first two are exact
  const double over = ((y.hi - c * x1) - c * x2) + (y.lo - c * x.lo);
  const double t = over / (x.hi + c * y.hi), z = t * t;
  const DoubleDouble arc = kArcs[static_cast<std::size_t>(j.whole)];
  return sumOfOrdered(arc.hi, arc.lo + (t + t * (z * polynomial(kShortSeries, z))));
}

// atan(y/x), 0 <= x, y, not both 0.
DoubleDouble arc(const DoubleDouble& y, const DoubleDouble& x) {
  return y.hi <= x.hi ? arcBelowOne(y, x) : kHalfPi - arcBelowOne(x, y);
}

// sqrt(1 - x^2), |x| <= 1.
DoubleDouble legOf(double x) {
  const DoubleDouble square = exactProduct(x, x), rest = sumOfOrdered(1, -square.hi);
  const DoubleDouble leg2 = sumOfOrdered(rest.hi, rest.lo - square.lo);
  if (!(leg2.hi > 0)) return {};
  const double root = std::sqrt(leg2.hi);
  const DoubleDouble again = exactProduct(root, root);
  return sumOfOrdered(root, (((leg2.hi - again.hi) - again.lo) + leg2.lo) / (2 * root));
}

// atan2(y, x) where one of them is zero or infinite, or so much larger that the angle is that of an axis.
double alongAxis(double y, double x) {
  const double sizes[] = {magnitude(y), magnitude(x)};
  // both infinite
  if (sizes[0] == sizes[1] && sizes[0] != 0) return withSignOf(isNegative(x) ? 1.5 * kHalfPi.hi : 0.5 * kHalfPi.hi, y);
  if (sizes[0] > sizes[1]) return withSignOf(kHalfPi.hi, y);
  return withSignOf(isNegative(x) ? 2 * kHalfPi.hi : 0, y);
}

}  // namespace

double atan(double x) {
  const double size = magnitude(x);
  if (size < 0x1p-27 || x != x) return x;
  if (size > 0x1p60) return withSignOf(kHalfPi.hi, x);
  return withSignOf(rounded(arc({size}, {1})), x);
}

double atan2(double y, double x) {
  if (x != x || y != y) return x + y;
  const double rise = magnitude(y), run = magnitude(x);
  // An infinite side has no significand: alongAxis answers for it.
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (rise == 0 || run == 0 || rise == kInfinite || run == kInfinite) return alongAxis(y, x);
  const Significand a = significandOf(rise), b = significandOf(run);
  const int apart = a.exponent - b.exponent;
  if (apart > 60) return withSignOf(kHalfPi.hi, y);
  if (apart < -60) return isNegative(x) ? withSignOf(2 * kHalfPi.hi, y) : y / run;
  const DoubleDouble angle = arc({scaled(a.m, apart)}, {b.m});
  return withSignOf(rounded(isNegative(x) ? 2.0 * kHalfPi - angle : angle), y);
}

double asin(double x) {
  const double size = magnitude(x);
  if (!(size <= 1)) return x != x ? x : kNotANumber;
  if (size < 0x1p-27) return x;
  return withSignOf(rounded(arc({size}, legOf(x))), x);
}

double acos(double x) {
  const double size = magnitude(x);
  if (!(size <= 1)) return x != x ? x : kNotANumber;
  const DoubleDouble angle = arc(legOf(x), {size});
  return rounded(x < 0 ? 2.0 * kHalfPi - angle : angle);
}

}  // namespace pincer::math
