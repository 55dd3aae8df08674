// The histogram against brute force: sorting all the values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pincer/tasks/run/servo/histogram.h"
#include "pincer/tests/support/allocation_guard.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::tasks {
namespace {

constexpr double kBinWidth = 1.0905077326652577;  // 2^(1/8)
constexpr double kRounding = 1e-13;               // of log2 and exp2 of numbers up to 34, a few ulp

// From 1 ns to 10 s, every decade alike.
std::vector<double> drawTimes(std::uint64_t seed, int n) {
  tests::RandomNumbers random(seed);
  std::vector<double> times;
  for (int i = 0; i < n; ++i) times.push_back(std::pow(10, random.uniform(-9, 1)));
  return times;
}

Histogram histogramOf(const std::vector<double>& times) {
  Histogram histogram;
  for (const double t : times) histogram.add(t);
  return histogram;
}

double nearestRank(std::vector<double> times, double q) {
  std::sort(times.begin(), times.end());
  const double rank = std::ceil(q * static_cast<double>(times.size()));
  return times[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

TEST(ServoHistogram, GivesQuantilesThatAreAtMostABinTooLarge) {
  for (const int n : {1, 2, 3, 10, 999, 20000}) {
    const std::vector<double> times = drawTimes(static_cast<std::uint64_t>(n), n);
    const Histogram histogram = histogramOf(times);
    for (const double q : {0.0, 0.001, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const double truth = nearestRank(times, q);
      EXPECT_GE(histogram.quantile(q), truth * (1 - kRounding)) << n << " times, q " << q;
      EXPECT_LE(histogram.quantile(q), truth * kBinWidth * (1 + kRounding)) << n << " times, q " << q;
    }
    EXPECT_EQ(histogram.quantile(1), *std::max_element(times.begin(), times.end()));
    EXPECT_EQ(histogram.count(), n);
  }
}

TEST(ServoHistogram, HasNoQuantileWhenEmpty) {
  EXPECT_EQ(Histogram().quantile(0.5), 0);
  EXPECT_EQ(Histogram().count(), 0);
  EXPECT_EQ(Histogram().largest(), 0);
}

TEST(ServoHistogram, TakesAnything) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double strange : {0.0, -1.0, -kInf, std::nan(""), 1e-300, 100.0, 1e300, kInf}) {
    Histogram histogram;
    histogram.add(strange);
    histogram.add(1e-3);
    EXPECT_EQ(histogram.count(), 2);
    EXPECT_GE(histogram.quantile(1), 1e-3);
  }
}

TEST(ServoHistogram, AddsAnotherAsIfItsTimesHadBeenAdded) {
  const std::vector<double> first = drawTimes(1, 300), second = drawTimes(2, 700);
  std::vector<double> both = first;
  both.insert(both.end(), second.begin(), second.end());
  Histogram sum = histogramOf(first);
  sum.add(histogramOf(second));
  const Histogram whole = histogramOf(both);
  EXPECT_EQ(sum.count(), whole.count());
  EXPECT_EQ(sum.largest(), whole.largest());
  for (double q = 0; q <= 1; q += 0.01) EXPECT_EQ(sum.quantile(q), whole.quantile(q)) << q;
}

TEST(ServoHistogram, AllocatesNothing) {
  if (!tests::allocationsAreCounted()) GTEST_SKIP() << "the sanitizer owns the allocator";
  const auto before = tests::allocationCount();
  Histogram histogram;
  for (int i = 0; i < 1000; ++i) histogram.add(1e-6 * i);
  EXPECT_EQ(tests::allocationCount() - before, 0);
}

}  // namespace
}  // namespace pincer::tasks
