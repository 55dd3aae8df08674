// Sine, cosine and tangent.
//
//   x = k pi/2 + r + r',  |r| <= pi/4;   sin r and cos r by their power series, and by k which of them with which sign
//
// Small arguments lose k pi/2 in parts of 33 bits, whose products with k are exact (W. J. Cody, W. Waite, "Software
// manual for the elementary functions", 1980); large ones are multiplied by just those digits of 2/pi that matter (M.
// Payne, R. Hanek, "Radian reduction for trigonometric functions", SIGNUM Newsletter 18, 1983).
#include <limits>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"

namespace pincer::math {
namespace {

__extension__ typedef unsigned __int128 Uint128;
__extension__ typedef __int128 Int128;

// 2/pi; pi/2 in parts of which the first three have at most 33 bits; pi/4, up to which nothing is reduced [rad].
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
constexpr double kHalfPiParts[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69, 0x1.b839a252049c1p-104};
constexpr double kMostByParts = 0x1p20;              // k of 20 bits times 33 bits: exact
constexpr double kQuarterPi = 0x1.921fb54442d18p-1;  // [rad]: up to here nothing is reduced

// Angles below are their own sine to half an ulp.
constexpr double kTiny = 0x1p-27;

// The binary digits of 2/pi behind the point, after 64 zeros.
constexpr std::uint64_t kDigits[] = {0,
                                     0xa2f9836e4e441529,
                                     0xfc2757d1f534ddc0,
                                     0xdb6295993c439041,
                                     0xfe5163abdebbc561,
                                     0xb7246e3a424dd2e0,
                                     0x06492eea09d1921c,
                                     0xfe1deb1cb129a73e,
                                     0xe88235f52ebb4484,
                                     0xe99c7026b45f7e41,
                                     0x3991d639835339f4,
                                     0x9c845f8bbdf9283b,
                                     0x1ff897ffde05980f,
                                     0xef2f118b5a0a6d1f,
                                     0x6d367ecf27cb09b7,
                                     0x4f463f669e5fea2d,
                                     0x7527bac7ebe5f17b,
                                     0x3d0739f78a5292ea,
                                     0x6bfb5fb11f8d5d08,
                                     0x56033046fc7b6bab,
                                     0xf0cfbc209af4361d};

struct Reduced {
  DoubleDouble r;
  int quadrant;  // k, of which the last two bits matter
};

Reduced byParts(double x) {
  const Nearest k = nearest(x * kTwoOverPi);
  const DoubleDouble a = exactSum(x - k.value * kHalfPiParts[0], -k.value * kHalfPiParts[1]);
  const DoubleDouble b = exactSum(a.hi, -k.value * kHalfPiParts[2]);
  return {sumOfOrdered(b.hi, b.lo + (a.lo - k.value * kHalfPiParts[3])), k.whole};
}

// 64 digits of 2/pi from digit `at` on.
std::uint64_t digits(int at) {
  const int word = at / 64, shift = at % 64;
  return shift == 0 ? kDigits[word] : kDigits[word] << shift | kDigits[word + 1] >> (64 - shift);
}

// x = m 2^e with m of 53 bits: digits of 2/pi before e - 1 give multiples of 4, which no
// function sees; after 192 more follows 2^-137.
[[gnu::noinline]] Reduced byDigits(double x) {
  const Significand s = significandOf(x);
  const auto m = static_cast<std::uint64_t>(s.m * 0x1p52);
  const int first = s.exponent - 52 - 2 + 64;
  const Uint128 low = static_cast<Uint128>(m) * digits(first + 128),
                middle = static_cast<Uint128>(m) * digits(first + 64) + (low >> 64);
  // in quarter turns, times 2^126, modulo 4
  const Uint128 turns = (static_cast<Uint128>(m * digits(first)) << 64) + middle;
  const int k = static_cast<int>((turns + (static_cast<Uint128>(1) << 125)) >> 126);
  const auto rest = static_cast<Int128>(turns - (static_cast<Uint128>(static_cast<unsigned>(k)) << 126));
  const auto hi = static_cast<double>(rest);
  const auto lo = static_cast<double>(rest - static_cast<Int128>(hi));
  const DoubleDouble quarters{hi * 0x1p-126, lo * 0x1p-126};
  return {quarters * kHalfPi, k};
}

Reduced reduced(double x) {
  const double size = magnitude(x);
  if (size <= kQuarterPi) return {{x, 0}, 0};
  if (size <= kMostByParts) return byParts(x);
  const Reduced angle = byDigits(size);
  return isNegative(x) ? Reduced{-angle.r, -angle.quadrant} : angle;
}

// Of |r| <= pi/4 the next terms are below 2^-62 of the sine and 2^-58 of the cosine.
constexpr double kSine[] = {-1.0 / 6,
                            1.0 / 120,
                            -1.0 / 5040,
                            1.0 / 362880,
                            -1.0 / 39916800,
                            1.0 / 6227020800.0,
                            -1.0 / 1307674368000.0,
                            1.0 / 355687428096000.0};  // 1/n!
constexpr double kCosine[] = {1.0 / 24,        -1.0 / 720,           1.0 / 40320,           -1.0 / 3628800,
                              1.0 / 479001600, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};

// Sine and cosine of r = hi + lo from their series' sums at z = hi^2.
double sineFrom(double sum, const DoubleDouble& r, double z) {
  return r.hi + (r.hi * (z * sum) + r.lo * (1 - 0.5 * z));
}
double cosineFrom(double sum, const DoubleDouble& r, double z) {
  const double half = 0.5 * z, w = 1 - half;
  return w + (((1 - w) - half) + (z * (z * sum) - r.hi * r.lo));
}

double sineOf(const DoubleDouble& r) { return sineFrom(polynomial(kSine, r.hi * r.hi), r, r.hi * r.hi); }
double cosineOf(const DoubleDouble& r) { return cosineFrom(polynomial(kCosine, r.hi * r.hi), r, r.hi * r.hi); }

// Both series side by side; the cosine's ends with a term of 0, which changes no bit.
using Both [[gnu::vector_size(16)]] = double;
// Terms of equal order, sine first: one instruction for both.
constexpr Both kBoth[] = {{kSine[0], kCosine[0]}, {kSine[1], kCosine[1]}, {kSine[2], kCosine[2]},
                          {kSine[3], kCosine[3]}, {kSine[4], kCosine[4]}, {kSine[5], kCosine[5]},
                          {kSine[6], kCosine[6]}, {kSine[7], 0}};

// Sine and cosine to 2^-57, for quotients of them: here the series begins where the exact cube ends.
DoubleDouble preciseSine(const DoubleDouble& r) {
  // 1/3! to twice the digits: a double would cost the bits that the exact cube keeps.
  constexpr DoubleDouble kSixth = DoubleDouble{1} / DoubleDouble{6};
  const double z = r.hi * r.hi;
  const DoubleDouble cubic = -r.hi * (exactProduct(r.hi, r.hi) * kSixth), sum = sumOfOrdered(r.hi, cubic.hi);
  const double beyond = r.hi * (z * (polynomial(kSine, z) + 1.0 / 6)) + r.lo * (1 - 0.5 * z);
  return sumOfOrdered(sum.hi, sum.lo + (cubic.lo + beyond));
}

DoubleDouble preciseCosine(const DoubleDouble& r) {
  const DoubleDouble square = exactProduct(r.hi, r.hi), sum = sumOfOrdered(1, -0.5 * square.hi);
  const double z = square.hi, beyond = z * (z * polynomial(kCosine, z)) - r.hi * (1 - z / 6) * r.lo;
  return sumOfOrdered(sum.hi, sum.lo + (beyond - 0.5 * square.lo));
}

double sineOf(const Reduced& angle, int quarters) {
  const int k = angle.quadrant + quarters;
  const double value = k & 1 ? cosineOf(angle.r) : sineOf(angle.r);
  return k & 2 ? -value : value;
}

bool isFinite(double x) { return magnitude(x) < std::numeric_limits<double>::infinity(); }

}  // namespace

double sin(double angle) {
  if (magnitude(angle) < kTiny) return angle;
  return isFinite(angle) ? sineOf(reduced(angle), 0) : angle - angle;
}

double cos(double angle) { return isFinite(angle) ? sineOf(reduced(angle), 1) : angle - angle; }

[[gnu::flatten]] SinCos sinCos(double angle) {
  if (magnitude(angle) < kTiny) return {angle, 1};
  if (!isFinite(angle)) return {angle - angle, angle - angle};
  const Reduced at = reduced(angle);
  const double z = at.r.hi * at.r.hi;
  const Both sums = polynomial(kBoth, Both{z, z});
  const double s = sineFrom(sums[0], at.r, z), c = cosineFrom(sums[1], at.r, z);
  const double sine = at.quadrant & 1 ? c : s, cosine = at.quadrant & 1 ? s : c;
  return {at.quadrant & 2 ? -sine : sine, (at.quadrant + 1) & 2 ? -cosine : cosine};
}

double tan(double angle) {
  if (magnitude(angle) < kTiny) return angle;
  if (!isFinite(angle)) return angle - angle;
  const Reduced at = reduced(angle);
  const DoubleDouble s = preciseSine(at.r), c = preciseCosine(at.r);
  return rounded(at.quadrant & 1 ? -c / s : s / c);
}

}  // namespace pincer::math
