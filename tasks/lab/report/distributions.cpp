#include "pincer/tasks/lab/report/distributions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

// Of the continued fraction [-]: stands for 0, which would be divided by; and ends it, at four times round-off.
constexpr double kSmallest = 1e-300, kContinuedTo = 1e-15;
constexpr int kMostTerms = 10'000;  // of it; ends what doesn't converge, chosen

double logGamma(double x) {
  constexpr double g = 7;
  constexpr std::array<double, 9> c = {0.99999999999980993,  676.5203681218851,     -1259.1392167224028,
                                       771.32342877765313,   -176.61502916214059,   12.507343278686905,
                                       -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7};
  double sum = c[0];
  for (std::size_t i = 1; i < c.size(); ++i) sum += c[i] / (x - 1 + static_cast<double>(i));
  const double t = x - 1 + g + 0.5;
  return 0.5 * math::log(2 * std::numbers::pi) + (x - 0.5) * math::log(t) - t + math::log(sum);
}

// 1 + d1 / (1 + d2 / (1 + ...)), d of 26.5.8.
double betaFraction(double x, double a, double b) {
  double f = 1, c = 1, d = 0;
  for (int k = 1; k < kMostTerms; ++k) {
    const int m = k / 2;
    const double term = k % 2 ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                              : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 + term * d;
    c = 1 + term / c;
    if (std::abs(d) < kSmallest) d = kSmallest;
    if (std::abs(c) < kSmallest) c = kSmallest;
    d = 1 / d;
    f *= c * d;
    if (std::abs(c * d - 1) < kContinuedTo) break;
  }
  return f;
}

template <class Function>
double simpson(double low, double high, int steps, const Function& f) {
  const double h = (high - low) / steps;
  double sum = f(low) + f(high);
  for (int k = 1; k < steps; ++k) sum += (k % 2 ? 4 : 2) * f(low + k * h);
  return sum * h / 3;
}

double normalBelow(double z) { return 0.5 * math::erfc(-z / std::numbers::sqrt2); }

// P(range of k standard normal numbers < w).
double rangeBelow(double w, int k) {
  constexpr double kFar = 8;   // SDs; beyond lies 1e-15
  constexpr int kSteps = 160;  // of a tenth of an SD; even, for Simpson
  return k * simpson(-kFar, kFar, kSteps, [&](double z) {
           const double density = math::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
           return density * math::pow(std::max(0.0, normalBelow(z) - normalBelow(z - w)), k - 1);
         });
}

}  // namespace

double incompleteBeta(double x, double a, double b) {
  PINCER_ASSERT(0 <= x && x <= 1 && a > 0 && b > 0);
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(1 - x, b, a);
  const double front = logGamma(a + b) - logGamma(a) - logGamma(b) + a * math::log(x) + b * math::log1p(-x);
  return math::exp(front) / a / betaFraction(x, a, b);
}

double fTail(double f, double m, double n) { return incompleteBeta(n / (n + m * f), 0.5 * n, 0.5 * m); }

double studentTail(double t, double n) { return incompleteBeta(n / (n + t * t), 0.5 * n, 0.5); }

double studentizedRangeTail(double q, int k, double n) {
  PINCER_ASSERT(q >= 0 && k >= 2 && n >= 1);
  constexpr int kSteps = 160;  // of a ninth of an SD; even, for Simpson
  constexpr double kFar = 9;   // SDs of s
  const double sd = 1 / std::sqrt(2 * n), low = std::max(0.0, 1 - kFar * sd), high = 1 + kFar * sd;
  const double scale = math::log(2.0) + 0.5 * n * math::log(0.5 * n) - logGamma(0.5 * n);
  const double below = simpson(low, high, kSteps, [&](double s) {
    if (s <= 0) return 0.0;
    return math::exp(scale + (n - 1) * math::log(s) - 0.5 * n * s * s) * rangeBelow(q * s, k);
  });
  return std::clamp(1 - below, 0.0, 1.0);
}

}  // namespace pincer::tasks
