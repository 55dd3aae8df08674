// double_double: numbers of 106 bits as the unevaluated sum of two doubles, and powers of two.
//
//   x = hi + lo,   |lo| <= ulp(hi) / 2
//
// Source: T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18 (1971)
// 224-242. Departure: products and sums are renormalised once, errors are a few 2^-104 relative where no digits cancel.
// All of it is constexpr: tables are computed by the compiler, in the arithmetic that runs.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

namespace pincer::math {

struct DoubleDouble {
  double hi = 0, lo = 0;
};

// a + b without error where |a| >= |b| or a = 0.
constexpr DoubleDouble sumOfOrdered(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

// a + b without error.
constexpr DoubleDouble exactSum(double a, double b) {
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}

// a b without error, by halves of 26 bits: |a|, |b| < 2^995, |a b| > 2^-968.
constexpr DoubleDouble exactProduct(double a, double b) {
  constexpr double kHalves = 0x1p27 + 1;  // splits 53 bits in two by rounding (Veltkamp)
  const double ca = kHalves * a, cb = kHalves * b;
  const double a1 = ca - (ca - a), a2 = a - a1, b1 = cb - (cb - b), b2 = b - b1;
  const double p = a * b;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = exactSum(a.hi, b.hi);
  return sumOfOrdered(s.hi, s.lo + (a.lo + b.lo));
}
constexpr DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }
constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
constexpr DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = exactProduct(a.hi, b.hi);
  return sumOfOrdered(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
constexpr DoubleDouble operator*(double a, const DoubleDouble& b) { return DoubleDouble{a} * b; }
constexpr DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double q = a.hi / b.hi;
  const DoubleDouble p = exactProduct(q, b.hi);
  return sumOfOrdered(q, (((a.hi - p.hi) - p.lo) + a.lo - q * b.lo) / b.hi);
}
constexpr DoubleDouble operator/(const DoubleDouble& a, double b) { return a / DoubleDouble{b}; }

constexpr double rounded(const DoubleDouble& a) { return a.hi + a.lo; }

// ---- bits

constexpr std::uint64_t bitsOf(double x) { return std::bit_cast<std::uint64_t>(x); }
constexpr double magnitude(double x) { return std::bit_cast<double>(bitsOf(x) & ~(std::uint64_t{1} << 63)); }
constexpr bool isNegative(double x) { return bitsOf(x) >> 63; }
constexpr double withSignOf(double size, double x) { return isNegative(x) ? -size : size; }

// 2^n, -1022 <= n <= 1023.
constexpr double powerOfTwo(int n) { return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52); }

// x 2^n, rounded once, for x of ordinary size (2^-100 .. 2^100) or 0 and any n.
constexpr double scaled(double x, int n) {
  if (n >= -900 && n <= 900) return x * powerOfTwo(n);
  if (n > 900)
    return n > 2000 ? x * powerOfTwo(1023) * powerOfTwo(1023) : x * powerOfTwo(n / 2) * powerOfTwo(n - n / 2);
  return n < -1200 ? x * powerOfTwo(-1000) * powerOfTwo(-1000) : x * powerOfTwo(-200) * powerOfTwo(n + 200);
}

// A positive, finite x as significand in [1, 2) times a power of two.
struct Significand {
  double m;
  int exponent;
};
constexpr Significand significandOf(double x) {
  const int lift = x < 0x1p-1022 ? 54 : 0;  // subnormal
  const std::uint64_t bits = bitsOf(lift ? x * 0x1p54 : x);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  return {std::bit_cast<double>(fraction | (std::uint64_t{1023} << 52)), static_cast<int>(bits >> 52) - 1023 - lift};
}

// The whole number nearest to x, |x| < 2^51, as a double and as an integer.
struct Nearest {
  double value;
  int whole;
};
constexpr Nearest nearest(double x) {
  constexpr double kShift = 0x1.8p52;  // there, doubles are the whole numbers
  const double t = x + kShift;
  return {t - kShift, static_cast<int>(static_cast<std::uint32_t>(bitsOf(t)))};
}

// Numbers that several functions use; tests/unit/contact/functions/accuracy_mpfr_test.cpp compares them with MPFR's.
constexpr DoubleDouble kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr DoubleDouble kLn2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

// sum of c[i] x^i, by pairs, which a processor works on side by side. Of numbers, or of several at once.
template <class Number, std::size_t N>
constexpr Number polynomial(const Number (&c)[N], Number x) {
  static_assert(N >= 2 && N <= 16);
  const auto pair = [&](std::size_t i) { return i + 1 < N ? c[i] + x * c[i + 1] : c[i]; };
  const Number x2 = x * x, x4 = x2 * x2;
  const auto four = [&](std::size_t i) { return i + 2 < N ? pair(i) + x2 * pair(i + 2) : pair(i); };
  const auto eight = [&](std::size_t i) { return i + 4 < N ? four(i) + x4 * four(i + 4) : four(i); };
  return N > 8 ? eight(0) + x4 * x4 * eight(8) : eight(0);
}

}  // namespace pincer::math
