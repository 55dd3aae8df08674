#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pincer/tasks/lab/report/statistics.h"

namespace pincer::tasks {
namespace {

// 0.975 quantiles as printed: Abramowitz & Stegun 1964, table 26.10, three decimals, so half a unit of the third.
TEST(StudentQuantile, IsWhatThePrintedTableSays) {
  const struct {
    int dof;
    double t;
  } table[] = {{1, 12.706}, {2, 4.303},  {3, 3.182},  {4, 2.776},  {5, 2.571},
               {9, 2.262},  {10, 2.228}, {29, 2.045}, {30, 2.042}, {120, 1.980}};
  for (const auto& row : table)
    EXPECT_NEAR(studentQuantile(0.95, row.dof), row.t, 5e-4) << row.dof << " degrees of freedom";
}

// Closed forms: one degree of freedom is Cauchy's distribution; two give P = t / sqrt(2 + t^2). The bisection finds the
// angle to 1 ulp, and t grows with 1 + t^2 per angle; 1e-12 leaves 4 decimal digits for the sum and the tangent.
RC_GTEST_PROP(StudentQuantile, IsClosedForOneAndTwoDegreesOfFreedom, ()) {
  const double p = *rc::gen::map(rc::gen::inRange(1, 999), [](int k) { return k / 1000.0; });
  const double cauchy = std::tan(0.5 * std::acos(-1.0) * p);
  RC_ASSERT(std::abs(studentQuantile(p, 1) - cauchy) <= 1e-12 * (1 + cauchy * cauchy));
  const double two = p * std::sqrt(2 / (1 - p * p));
  RC_ASSERT(std::abs(studentQuantile(p, 2) - two) <= 1e-12 * (1 + two * two));
}

// Against the density, integrated by Simpson's rule: an independent route to the same
// probability. 1e-9: the rule's error at this step.
RC_GTEST_PROP(StudentTwoSided, IsTheIntegralOfTheDensity, ()) {
  const int dof = *rc::gen::inRange(1, 60);
  const double t = *rc::gen::map(rc::gen::inRange(1, 500), [](int k) { return k / 100.0; });
  const double scale =
      std::exp(std::lgamma(0.5 * (dof + 1)) - std::lgamma(0.5 * dof)) / std::sqrt(dof * std::acos(-1.0));
  const auto density = [&](double x) { return scale * std::pow(1 + x * x / dof, -0.5 * (dof + 1)); };
  constexpr int kSteps = 2000;
  double integral = 0;
  for (int k = 0; k <= kSteps; ++k) integral += (k == 0 || k == kSteps ? 1 : k % 2 ? 4 : 2) * density(t * k / kSteps);
  RC_ASSERT(std::abs(studentTwoSided(t, dof) - 2 * integral * t / kSteps / 3) <= 1e-9);
}

// Of many samples of five normal numbers, 95 % of the intervals hold the true mean. 0.006:
// 4 SD of the share in 20,000 repetitions.
TEST(EstimateMean, CoversTheTruthNinetyFiveTimesInAHundred) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(3, 2);
  int covered = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::vector<double> values(5);
    for (double& x : values) x = normal(random);
    const Estimate e = estimateMean(values);
    covered += std::abs(e.mean - 3) < e.half_width;
  }
  EXPECT_NEAR(covered / 20'000.0, 0.95, 0.006);
}

TEST(EstimateMean, SaysWhatItCanNotKnow) {
  EXPECT_TRUE(std::isnan(estimateMean({}).mean));
  EXPECT_EQ(estimateMean({7}).mean, 7);
  EXPECT_TRUE(std::isnan(estimateMean({7}).half_width));
  EXPECT_EQ(estimateMean({2, 2, 2}).half_width, 0);
}

// By hand: mean 3, s = sqrt(2.5), half = 2.7764 s / sqrt 5; t to the table's four decimals.
TEST(EstimateMean, IsRightForFiveNumbers) {
  const Estimate e = estimateMean({1, 2, 3, 4, 5});
  EXPECT_EQ(e.n, 5);
  EXPECT_DOUBLE_EQ(e.mean, 3);
  EXPECT_NEAR(e.half_width, 2.7764 * std::sqrt(0.5), 1e-4);
}

// Of eight waiting times, skewed to the right: symmetric intervals hold the mean in 89 % of the samples, these in 93 %
// (of 20,000; 4 SD are 0.8 %), and none of them is below zero.
TEST(IntervalOf, OfCountsAndTimesIsNeverBelowZeroAndHoldsTheMeanMoreOften) {
  std::mt19937_64 random(1);
  std::exponential_distribution<double> waiting(1.0 / 3);
  int covered = 0, symmetric = 0;
  for (int k = 0; k < 20'000; ++k) {
    std::vector<double> values(8);
    for (double& x : values) x = waiting(random);
    const Estimate e = estimateMean(values);
    const Interval interval = intervalOf(e, Averaged::kPositive);
    EXPECT_GT(interval.low, 0);
    EXPECT_NEAR(interval.low * interval.high, e.mean * e.mean, 1e-9 * e.mean * e.mean);
    covered += interval.low < 3 && 3 < interval.high;
    symmetric += std::abs(e.mean - 3) < e.half_width;
  }
  EXPECT_GT(covered, symmetric);
  EXPECT_NEAR(covered / 20'000.0, 0.93, 0.008);
}

TEST(IntervalOf, OfSharesStaysBetweenNoneAndAll) {
  const Interval percent = intervalOf(estimateMean({95, 100, 90, 95}), Averaged::kPercent);
  EXPECT_GT(percent.low, 0);
  EXPECT_LT(percent.high, 100);
  EXPECT_LT(percent.low, 95);
  const Interval share = intervalOf(estimateMean({0.95, 1, 0.9, 0.95}), Averaged::kShare);
  EXPECT_NEAR(share.high, percent.high / 100, 1e-12);
  const Interval all = intervalOf(estimateMean({1, 1, 1}), Averaged::kShare);
  EXPECT_EQ(all.low, 1);
  EXPECT_EQ(all.high, 1);
}

TEST(IntervalOf, OfDifferencesIsSymmetric) {
  const Estimate e = estimateMean({-1, 2, 4});
  const Interval interval = intervalOf(e, Averaged::kAny);
  EXPECT_DOUBLE_EQ(interval.low + interval.high, 2 * e.mean);
  EXPECT_LT(interval.low, 0);
}

RC_GTEST_PROP(Percentile, IsTheNearestRank, (std::vector<int> numbers)) {
  RC_PRE(!numbers.empty());
  const int hundredths = *rc::gen::inRange(0, 101);
  std::vector<double> values(numbers.begin(), numbers.end());
  const double x = percentile(values, hundredths / 100.0);
  const auto below = std::count_if(values.begin(), values.end(), [x](double v) { return v <= x; });
  const auto strictly = std::count_if(values.begin(), values.end(), [x](double v) { return v < x; });
  const double wanted = hundredths / 100.0 * static_cast<double>(values.size());
  RC_ASSERT(static_cast<double>(below) >= wanted - 1e-9);  // rounding of hundredths / 100 * n
  RC_ASSERT(static_cast<double>(strictly) <= std::max(0.0, wanted + 1e-9));
}

}  // namespace
}  // namespace pincer::tasks
