// log, log2, log10, log1p, pow.
//
//   log(2^k m) = k ln 2 - log c + log(1 + r),   c about 1/m, from a table,   r = c m - 1 exact,   |r| < 2^-7
//
// m in (0.7, 1.42), so that k = 0 about 1, and c = 1 there: log x has small relative error where it vanishes.
// Source: P. T. P. Tang, "Table-driven implementation of the logarithm function in IEEE floating-point arithmetic", ACM
// Trans. Math. Softw. 16 (1990) 378-400. Departure: c has 11 bits, so that r needs no rounding.
#include <array>
#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"
#include "pincer/contact/functions/exponential.h"

namespace pincer::math {
namespace {

// Answers at the edges of the domains: -log 0, and the logarithm of a negative number.
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

// 1/ln 2 and 1/ln 10 to twice the digits: their products are rounded once, at the end.
constexpr DoubleDouble kOverLn2{0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56},
    kOverLn10{0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};

// Multiples of 2^-42, so that sums of them with k ln 2 are exact.
constexpr double kLn2Coarse = 0x1.62e42fefa38p-1, kLn2Rest = 0x1.ef35793c7673p-45;

constexpr int kCells = 128, kFirst = 90, kLast = 182;  // of m, cells of 1/128

struct Cell {
  double c = 0, coarse = 0, rest = 0;  // coarse + rest = -log c
};

// log c = 2 artanh((c - 1) / (c + 1))
constexpr DoubleDouble logarithmOf(double c) {
  const DoubleDouble z = DoubleDouble{c - 1} / DoubleDouble{c + 1}, zz = z * z;
  DoubleDouble power = z, sum = z;
  for (int n = 3; n < 48; n += 2) {
    power = power * zz;
    sum = sum + power / n;
  }
  return 2.0 * sum;
}

// Per cell of m: c and -log c, worked out by the compiler.
constexpr auto kTable = [] {
  std::array<Cell, kLast - kFirst + 1> table{};
  for (int j = kFirst; j <= kLast; ++j) {
    Cell& cell = table[static_cast<std::size_t>(j - kFirst)];
    cell.c = nearest(1024.0 * kCells / j).value / 1024;
    const DoubleDouble log = logarithmOf(cell.c);
    cell.coarse = nearest(-log.hi * 0x1p42).value * 0x1p-42;
    cell.rest = (-log.hi - cell.coarse) - log.lo;
  }
  return table;
}();

// log x = coarse + r - r^2/2 + ... + rest; coarse is 0 or larger than r.
struct Parts {
  double coarse;
  DoubleDouble r;
  double rest;
};

// Of 2^k m.
Parts partsOf(double m, int k) {
  if (m > 0x1.6a09e667f3bcdp+0) m *= 0.5, ++k;
  const Cell& cell = kTable[static_cast<std::size_t>(nearest(m * kCells).whole - kFirst)];
  const double m1 = std::bit_cast<double>(bitsOf(m) & ~std::uint64_t{0xffffffff}), m2 = m - m1;
  const DoubleDouble r = sumOfOrdered(cell.c * m1 - 1, cell.c * m2);
  return {k * kLn2Coarse + cell.coarse, r, k * kLn2Rest + cell.rest};
}

Parts partsOf(double x) {
  const Significand s = significandOf(x);
  return partsOf(s.m, s.exponent);
}

// Terms of log(1 + r) from r^3 on: of |r| < 2^-7 the next is below 2^-66.
constexpr double kSeries[] = {1.0 / 3, -1.0 / 4, 1.0 / 5, -1.0 / 6, 1.0 / 7, -1.0 / 8};

double valueOf(const Parts& parts) {
  const double r = parts.r.hi;
  const DoubleDouble sum = sumOfOrdered(parts.coarse, r);
  const double beyond = r * r * (r * polynomial(kSeries, r) - 0.5);
  return sum.hi + (sum.lo + (parts.rest + parts.r.lo + beyond));
}

// To 2^-67, relative.
DoubleDouble preciseOf(const Parts& parts) {
  const double r = parts.r.hi;
  const DoubleDouble sum = sumOfOrdered(parts.coarse, r), square = exactProduct(r, r);
  const DoubleDouble less = sumOfOrdered(sum.hi, -0.5 * square.hi);
  const double beyond = (parts.r.lo - r * parts.r.lo) - 0.5 * square.lo + r * square.hi * polynomial(kSeries, r);
  return sumOfOrdered(less.hi, less.lo + sum.lo + (parts.rest + beyond));
}

bool isOrdinary(double x) { return x > 0 && x < kInfinite; }

// Logarithm, to any base, of an x that isn't ordinary.
double logarithmOfSpecial(double x) { return x == 0 ? -kInfinite : x < 0 ? kNotANumber : x; }

bool isWhole(double y) { return magnitude(y) >= 0x1p52 || (magnitude(y) + 0x1p52) - 0x1p52 == magnitude(y); }
bool isOdd(double y) { return magnitude(y) < 0x1p53 && isWhole(y) && !isWhole(0.5 * y); }

// x^y for x = 0, infinite, and y != 0 any number.
double powerOfSpecial(double x, double y) {
  const double size = (x == 0) == (y > 0) ? 0 : kInfinite;
  return isNegative(x) && isOdd(y) ? -size : size;
}

// x^y for ordinary x.
double powerOf(double x, double y) {
  constexpr double kFar = 0x1p64, kNear = 0x1p-65;  // |log x| is 2^-53 at least where it isn't 0, and 745 at most
  if (magnitude(y) >= kFar) return x == 1 ? 1 : (x > 1) == (y > 0) ? kInfinite : 0;
  if (magnitude(y) < kNear) return 1;
  const DoubleDouble log = preciseOf(partsOf(x)), product = exactProduct(y, log.hi);
  return exponential(sumOfOrdered(product.hi, product.lo + y * log.lo));
}

}  // namespace

double log(double x) { return isOrdinary(x) ? valueOf(partsOf(x)) : logarithmOfSpecial(x); }

double log2(double x) {
  if (!isOrdinary(x)) return logarithmOfSpecial(x);
  Significand s = significandOf(x);
  if (s.m > 0x1.6a09e667f3bcdp+0) s = {0.5 * s.m, s.exponent + 1};
  const DoubleDouble part = preciseOf(partsOf(s.m, 0)) * kOverLn2;
  return rounded(DoubleDouble{static_cast<double>(s.exponent)} + part);
}

double log10(double x) { return isOrdinary(x) ? rounded(preciseOf(partsOf(x)) * kOverLn10) : logarithmOfSpecial(x); }

double log1p(double x) {
  constexpr double kAboutOne = 0x1p-8;  // |x|: up to here the series about one alone
  if (magnitude(x) < 0x1p-54) return x;
  if (magnitude(x) < kAboutOne) return valueOf({0, {x, 0}, 0});
  if (!(x > -1 && x < 0x1p54)) return log(1 + x);
  const DoubleDouble sum = exactSum(1, x);
  Parts parts = partsOf(sum.hi);
  parts.rest += sum.lo / sum.hi;
  return valueOf(parts);
}

double pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y) return x + y;
  const double size = magnitude(x);
  if (magnitude(y) == kInfinite) return size == 1 ? 1 : (size > 1) == (y > 0) ? kInfinite : 0;
  if (!isOrdinary(size)) return powerOfSpecial(x, y);
  if (x > 0) return powerOf(x, y);
  if (!isWhole(y)) return kNotANumber;
  return isOdd(y) ? -powerOf(size, y) : powerOf(size, y);
}

}  // namespace pincer::math
