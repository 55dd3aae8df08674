// exp, exp2, expm1.
//
//   e^x = 2^(k/64) e^r,   k the whole number nearest to 64 x / ln 2,   |r| <= ln 2 / 128
//
// 2^(j/64) from a table, e^r by its power series. Source: P. T. P. Tang, "Table-driven implementation of
// the exponential function in IEEE floating-point arithmetic", ACM Trans. Math. Softw. 15 (1989)
// 144-157. Departure: the table has 106 bits.
#include "pincer/contact/functions/exponential.h"

#include <array>

#include "pincer/contact/elementary.h"

namespace pincer::math {
namespace {

constexpr int kParts = 64;                              // of a power of two: entries of the table
constexpr double kPartsOverLn2 = 0x1.71547652b82fep+6;  // 64 / ln 2
// ln 2 / 64; times k exact: 34 and 17 bits
constexpr double kPart = 0x1.62e42fef8p-7, kPartRest = 0x1.1cf79abc9e3b4p-42;
constexpr double kOverflows = 710, kVanishes = -746;  // e^x beyond the largest double, below half the smallest

constexpr auto kRoots = [] {
  std::array<DoubleDouble, kParts> roots{};  // 2^(j/64)
  for (int j = 0; j < kParts; ++j) {
    const DoubleDouble x = static_cast<double>(j) / kParts * kLn2;
    DoubleDouble sum{1}, term{1};
    for (int n = 1; n < 28; ++n) sum = sum + (term = term * x / n);
    roots[static_cast<std::size_t>(j)] = sum;
  }
  return roots;
}();

struct Parts {
  DoubleDouble root;
  double beyond;  // root (e^r - 1)
  int power;      // of 2
};

// 1/n!, n from 2: of |r| <= ln 2 / 128 the next term is below 2^-64.
constexpr double kSeries[] = {1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720};

Parts partsOf(int k, double r) {
  const DoubleDouble root = kRoots[static_cast<std::size_t>(k & (kParts - 1))];
  return {root, root.lo + root.hi * (r + r * r * polynomial(kSeries, r)), k >> 6};
}

Parts partsOf(const DoubleDouble& x) {
  const Nearest k = nearest(x.hi * kPartsOverLn2);
  return partsOf(k.whole, (x.hi - k.value * kPart) + (x.lo - k.value * kPartRest));
}

double valueOf(const Parts& parts) { return scaled(parts.root.hi + parts.beyond, parts.power); }

// 1/n!, n from 2: of |x| < 1/8 the next term is below 2^-61 of x.
constexpr double kInverseFactorials[] = {1.0 / 2,    1.0 / 6,     1.0 / 24,     1.0 / 120,     1.0 / 720,
                                         1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800};

}  // namespace

double exponential(const DoubleDouble& x) {
  if (!(x.hi > kVanishes)) return x.hi != x.hi ? x.hi : 0;
  if (x.hi > kOverflows) return powerOfTwo(1023) * 2 * x.hi;
  return valueOf(partsOf(x));
}

double exp(double x) { return exponential({x, 0}); }

double exp2(double x) {
  if (!(x > -1080)) return x != x ? x : 0;
  if (x >= 1024) return powerOfTwo(1023) * x;
  const Nearest k = nearest(kParts * x);
  return valueOf(partsOf(k.whole, (x - k.value / kParts) * kLn2.hi));
}

double expm1(double x) {
  constexpr double kSeriesReaches = 0.125;  // beyond, e^x and 1 cancel no more than the table has digits
  const double size = magnitude(x);
  if (size < 0x1p-54) return x;
  if (size < kSeriesReaches) return x + x * x * polynomial(kInverseFactorials, x);
  if (!(x <= 600)) return exp(x);  // also what isn't a number
  if (x < -40) return -1;
  const Parts parts = partsOf({x, 0});
  const double power = powerOfTwo(parts.power);
  const DoubleDouble less = exactSum(power * parts.root.hi, -1);
  return less.hi + (less.lo + power * parts.beyond);
}

}  // namespace pincer::math
