#include "pincer/tasks/lab/report/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/contact/elementary.h"
#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  // no figure

// P(|T| < sqrt(dof) tan(theta)).
double twoSidedOfAngle(double theta, int dof) {
  const double c = math::cos(theta), s = math::sin(theta);
  const bool odd = dof % 2 == 1;
  double term = odd ? c : 1, sum = dof > 1 ? term : 0;
  for (int k = odd ? 3 : 2; k < dof; k += 2) {
    term *= c * c * (k - 1) / k;
    sum += term;
  }
  return odd ? 2 / std::numbers::pi * (theta + s * sum) : s * sum;
}

}  // namespace

double studentTwoSided(double t, int dof) {
  PINCER_ASSERT(!(t < 0) && dof >= 1);
  return twoSidedOfAngle(math::atan(t / std::sqrt(dof)), dof);
}

double studentQuantile(double probability, int dof) {
  PINCER_ASSERT(0 < probability && probability < 1 && dof >= 1);
  double low = 0, high = std::numbers::pi / 2;
  for (int k = 0; k < std::numeric_limits<double>::digits; ++k) {
    const double middle = 0.5 * (low + high);
    (twoSidedOfAngle(middle, dof) < probability ? low : high) = middle;
  }
  return std::sqrt(dof) * math::tan(0.5 * (low + high));
}

Estimate estimateMean(const std::vector<double>& values) {
  const int n = static_cast<int>(values.size());
  if (n == 0) return {0, kNaN, kNaN};
  double sum = 0, squares = 0;
  for (const double x : values) sum += x;
  const double mean = sum / n;
  for (const double x : values) squares += (x - mean) * (x - mean);
  if (n == 1) return {1, mean, kNaN};
  return {n, mean, studentQuantile(0.95, n - 1) * std::sqrt(squares / (n - 1) / n)};
}

Interval intervalOf(const Estimate& e, Averaged averaged) {
  if (e.n < 2 || !(e.half_width > 0)) return {e.mean, e.mean};
  const double whole = averaged == Averaged::kPercent ? 100 : 1, share = e.mean / whole;
  if (averaged == Averaged::kAny) return {e.mean - e.half_width, e.mean + e.half_width};
  if (averaged == Averaged::kPositive) {
    if (!(e.mean > 0)) return {e.mean, e.mean};
    const double factor = math::exp(e.half_width / e.mean);
    return {e.mean / factor, e.mean * factor};
  }
  if (!(share > 0 && share < 1)) return {e.mean, e.mean};
  const double odds = share / (1 - share), factor = math::exp(e.half_width / whole / (share * (1 - share)));
  return {whole * odds / (odds + factor), whole * odds * factor / (1 + odds * factor)};
}

double percentile(std::vector<double> values, double p) {
  PINCER_ASSERT(0 <= p && p <= 1);
  if (values.empty()) return kNaN;
  const double last = static_cast<double>(values.size()) - 1;
  const auto rank =
      static_cast<std::ptrdiff_t>(std::clamp(std::ceil(p * static_cast<double>(values.size())) - 1, 0.0, last));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

}  // namespace pincer::tasks
