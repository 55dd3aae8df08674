// erfc.
//
//   |x| < 1/4     1 - erf x, erf by its power series
//   x < 4         e^(-x^2) w(x),  w = e^(x^2) erfc x  by its Taylor series about the nearest eighth:
//                 w' = 2 x w - 2/sqrt(pi), hence
//                 a_1 = 2 c a_0 - 2/sqrt(pi),   a_(n+1) = (2 c a_n + 2 a_(n-1)) / (n + 1)
//   beyond        the same with Laplace's continued fraction,
//                 sqrt(pi) w = 1 / (x + (1/2) / (x + (2/2) / (x + (3/2) / (x + ...
// Source: NIST Digital Library of Mathematical Functions, 7.6.1, 7.6.2, 7.9.2.
#include <array>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/double_double.h"
#include "pincer/contact/functions/exponential.h"

namespace pincer::math {
namespace {

// 2/sqrt(pi), to twice the digits: w is the difference of two sums that nearly cancel.
constexpr DoubleDouble kTwoOverRootPi{0x1.20dd750429b6dp+0, 0x1.1ae3a914fed8p-56};
constexpr int kPerUnit = 8, kFirst = 2, kLast = 32;  // nodes at 2/8 .. 32/8
constexpr std::size_t kOrder = 15;                   // terms: |h| <= 1/16, whose 15th power is 2^-60

struct Node {
  double low = 0;  // of a_0
  double a[kOrder] = {};
};

// w(c) = e^(c^2) - 2/sqrt(pi) sum 2^n c^(2n+1) / (2n+1)!!
constexpr DoubleDouble scaledComplement(double c) {
  const DoubleDouble cc{c * c};  // exact: c of 6 bits
  DoubleDouble power{1}, sum{1}, odd{c}, odd_sum{c};
  for (int n = 1; n < 100; ++n) {
    sum = sum + (power = power * cc / n);
    odd_sum = odd_sum + (odd = odd * (2.0 * cc) / (2 * n + 1));
  }
  return sum - kTwoOverRootPi * odd_sum;
}

// Taylor coefficients of w about each node, worked out by the compiler.
constexpr auto kNodes = [] {
  std::array<Node, kLast - kFirst + 1> nodes{};
  for (int j = kFirst; j <= kLast; ++j) {
    Node& node = nodes[static_cast<std::size_t>(j - kFirst)];
    const double c = static_cast<double>(j) / kPerUnit;
    DoubleDouble before = scaledComplement(c), here = 2 * c * before - kTwoOverRootPi;
    node.low = before.lo;
    node.a[0] = before.hi, node.a[1] = here.hi;
    for (std::size_t n = 1; n + 1 < kOrder; ++n) {
      const DoubleDouble next = (2 * c * here + 2.0 * before) / static_cast<double>(n + 1);
      before = here, here = next;
      node.a[n + 1] = here.hi;
    }
  }
  return nodes;
}();

double byTaylor(double x) {
  const Nearest j = nearest(x * kPerUnit);
  const Node& node = kNodes[static_cast<std::size_t>(j.whole - kFirst)];
  const double h = x - j.value / kPerUnit;
  double sum = node.a[kOrder - 1];
  for (std::size_t n = kOrder - 1; n-- > 1;) sum = node.a[n] + h * sum;
  return node.a[0] + (node.low + h * sum);
}

double byFraction(double x) {
  constexpr int kDepth = 24;  // from 21 on no bit changes at 4, sooner beyond
  double rest = x;
  for (int n = kDepth; n > 1; --n) rest = x + 0.5 * n / rest;
  return rounded(0.5 * kTwoOverRootPi / sumOfOrdered(x, 0.5 / rest));
}

// erfc(x), x >= 1/4.
double tail(double x) {
  const double w = x < 4 ? byTaylor(x) : byFraction(x);
  const DoubleDouble square = exactProduct(x, x);
  return exponential({-square.hi, -square.lo}) * w;
}

// (-1)^n / (n! (2n + 1)), n from 1
constexpr double kSeries[] = {-1.0 / 3,   1.0 / 10,     -1.0 / 42,    1.0 / 216,     -1.0 / 1320,
                              1.0 / 9360, -1.0 / 75600, 1.0 / 685440, -1.0 / 6894720};

double erf(double x) {
  const double z = x * x;
  const double t = x * (z * polynomial(kSeries, z));
  return kTwoOverRootPi.hi * x + (kTwoOverRootPi.lo * x + kTwoOverRootPi.hi * t);
}

}  // namespace

double erfc(double x) {
  if (x != x) return x;
  if (x > 28) return 0;
  if (x < -6) return 2;
  if (magnitude(x) < 0.25) return 1 - erf(x);
  return x > 0 ? tail(x) : 2 - tail(-x);
}

}  // namespace pincer::math
