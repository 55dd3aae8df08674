#include "pincer/engine/motion/one_freedom.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::engine {
namespace {

constexpr int kMostTerms = 24;             // of a series
constexpr double kRoundOffOfTerm = 1e-17;  // of the largest term: the tail is far below it
constexpr double kLongestTurn = 0.25;      // (|w| + natural frequency) h, of one series: its terms fall by 6 at least
constexpr double kLargestDecay = 1;        // c h of one series
constexpr double kMostDecay = 8;           // c h beyond which the exponential takes over
constexpr double kMostSteps = 64;          // series in a tick

// 1 / n: a division costs as much as the rest of a short sum.
constexpr std::array<double, kMostTerms + 1> kInverse = [] {
  std::array<double, kMostTerms + 1> inverse{};
  for (int n = 1; n <= kMostTerms; ++n) inverse[static_cast<std::size_t>(n)] = 1.0 / n;
  return inverse;
}();

// The course of one series. x_n, C_n, S_n: coefficients of th, cos th, sin th in t/h;  C' = -S th',  S' = C th'.
OneFreedomCourse sumSeries(const OneFreedomLaw& law, double rate, double h) {
  double nx[kMostTerms + 1], C[kMostTerms], S[kMostTerms];  // nx[n] = n x_n
  const double a = h * h * law.a, b = h * h * law.b, c = h * law.c, d = h * h * law.d;
  nx[0] = 0;
  nx[1] = rate * h;
  C[0] = 1;
  S[0] = 0;
  double way = nx[1], speed = nx[1], largest = std::abs(nx[1]);
  // terms in a row: of four, three may be nothing by symmetry (let go at the height of its pivot: t^2, t^6, t^10)
  int small = 0;
  for (std::size_t n = 0; n + 2 <= kMostTerms && small < 4; ++n) {
    if (n > 0) {
      double dC = 0, dS = 0;
      for (std::size_t k = 1; k <= n && law.turns; ++k) {
        dC -= nx[k] * S[n - k];
        dS += nx[k] * C[n - k];
      }
      C[n] = dC * kInverse[n];
      S[n] = dS * kInverse[n];
    }
    const double push = a * C[n] + b * S[n] + (n == 0 ? d : 0);
    const double term = (push - c * nx[n + 1]) * kInverse[n + 1];
    nx[n + 2] = term;
    speed += term;
    way += term * kInverse[n + 2];
    largest = std::max(largest, std::abs(term));
    small = std::abs(term) <= kRoundOffOfTerm * largest ? small + 1 : 0;
  }
  return {way, speed / h};
}

// Of a constant force a.
OneFreedomCourse decay(double a, double c, double rate, double h) {
  const double gone = -math::expm1(-c * h), last = a / c;
  return {last * h + (rate - last) * gone / c, last + (rate - last) * (1 - gone)};
}

OneFreedomCourse decayTurning(const OneFreedomLaw& law, double rate, double h) {
  if (!law.turns) return decay(law.a, law.c, rate, h);
  const double middle = decay(law.a, law.c, rate, 0.5 * h).way;
  const auto [sin, cos] = math::sinCos(middle);
  return decay(law.a * cos + law.b * sin + law.d, law.c, rate, h);
}

}  // namespace

OneFreedomCourse followFreedom(const OneFreedomLaw& law, double rate, double h) {
  PINCER_ASSERT(law.c >= 0);
  if (!(h > 0)) return {0, rate};
  const double turning =
      law.turns ? h * (std::abs(rate) + std::sqrt(math::hypot(law.a, law.b) + std::abs(law.d))) / kLongestTurn : 0;
  const double steps = std::ceil(std::max({1.0, turning, h * law.c / kLargestDecay}));
  if (!(h * law.c <= kMostDecay)) return decayTurning(law, rate, h);
  if (!(steps <= kMostSteps))
    return {h * (rate + h * (law.a + law.d)), rate + h * (law.a + law.d)};  // several turns in a tick: only finite
  OneFreedomCourse end{0, rate};
  OneFreedomLaw here = law;
  for (int n = 0; n < static_cast<int>(steps); ++n) {
    const OneFreedomCourse part = sumSeries(here, end.rate, h / steps);
    end = {end.way + part.way, part.rate};
    if (!law.turns || steps == 1) continue;
    const auto [sin, cos] = math::sinCos(end.way);
    here.a = law.a * cos + law.b * sin;
    here.b = law.b * cos - law.a * sin;
  }
  return end;
}

double dampedShare(double c, double h) {
  PINCER_ASSERT(c >= 0);
  const double x = c * h;
  return x > 0 ? -math::expm1(-x) / x : 1;
}

double dampedWay(double c, double h) {
  constexpr double kSmall = 0.1;  // below, the series is exact to round-off and the difference isn't
  const double x = c * h, xx = x * x;
  if (x < kSmall) return 0.5 + x * (1.0 / 12 - xx * (1.0 / 720 - xx * (1.0 / 30240 - xx / 1209600)));
  return -1 / math::expm1(-x) - 1 / x;
}

}  // namespace pincer::engine
