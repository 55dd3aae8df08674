#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

// By enumeration of all signs.
double wilcoxonByBruteForce(const std::vector<double>& ranks_with_sign) {
  double positive = 0, total = 0;
  for (const double r : ranks_with_sign) {
    total += std::abs(r);
    positive += r > 0 ? r : 0;
  }
  const double smaller = std::min(positive, total - positive);
  const std::size_t n = ranks_with_sign.size();
  int as_small = 0;
  for (std::size_t signs = 0; signs < (std::size_t{1} << n); ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += (signs >> i & 1) ? std::abs(ranks_with_sign[i]) : 0;
    as_small += sum <= smaller + 1e-9;
  }
  return std::min(1.0, 2.0 * as_small / static_cast<double>(std::size_t{1} << n));
}

TEST(Wilcoxon, CountsEverySign) {
  for (const std::vector<double>& ranks : std::vector<std::vector<double>>{{1, 2, 3, 4, 5},
                                                                           {-1, 2, 3, 4, 5, 6},
                                                                           {1, -2, 3, -4, 5, 6, 7, -8},
                                                                           {1.5, 1.5, -3, 4.5, 4.5},
                                                                           {-1, -2, -3, -4, -5, -6, -7}}) {
    // sums of halves: exact but for the count's division
    EXPECT_NEAR(wilcoxonSignedRank(ranks), wilcoxonByBruteForce(ranks), 1e-12);
  }
}

// Twelve of one sign: 2/2^12.
TEST(Wilcoxon, OfTwelveOfOneSignIsTwoInFourThousand) {
  std::vector<double> d;
  for (int i = 1; i <= 12; ++i) d.push_back(i);
  EXPECT_NEAR(wilcoxonSignedRank(d), 2.0 / 4096, 1e-15);
  EXPECT_EQ(wilcoxonSignedRank({0, 0, 0}), 1);
}

// W. S. Gosset ("Student"), Biometrika 6(1), 1908, p. 20: hours of sleep gained by two
// drugs, ten patients; t = 4.06, p = 0.0028.
TEST(PairedTest, OfStudentsSleepers) {
  const std::vector<double> first = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0};
  const std::vector<double> second = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  const PairedTest test = comparePairs(first, second);
  EXPECT_EQ(test.n, 10);
  EXPECT_NEAR(test.difference.mean, 1.58, 1e-12);
  EXPECT_NEAR(test.effect * std::sqrt(10), 4.0621, 5e-5);  // the digits of the source and of R's data set `sleep`
  EXPECT_NEAR(test.p_t, 0.002833, 5e-7);
}

// Was 1 for people who all differ by the same: the opposite of what they show.
TEST(PairedTest, CanNotTellByTHowSureIsWhatVariesInNobody) {
  EXPECT_TRUE(std::isnan(comparePairs({60, 70, 80, 90}, {75, 85, 95, 105}).p_t));
  EXPECT_NEAR(comparePairs({60, 70, 80, 90}, {75, 85, 95, 105}).p_wilcoxon, 0.125, 1e-12);
  EXPECT_EQ(comparePairs({60, 70}, {60, 70}).p_t, 1);
}

TEST(PairedTest, LeavesOutPeopleWithoutANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const PairedTest test = comparePairs({1, nan, 3, 4}, {2, 2, nan, 6});
  EXPECT_EQ(test.n, 2);
  EXPECT_NEAR(test.difference.mean, 1.5, 1e-15);
  EXPECT_EQ(comparePairs({1}, {2}).p_t, 1);
}

// Wilson's interval of 0 of 20 reaches to z^2/(n + z^2), and of half of them is symmetric.
TEST(WilsonInterval, OfNoneAndOfHalf) {
  const auto none = wilsonInterval(0, 20), half = wilsonInterval(10, 20);
  EXPECT_EQ(none.first, 0);
  EXPECT_NEAR(none.second, 3.841458820694124 / 23.841458820694124, 1e-12);
  EXPECT_NEAR(half.first + half.second, 1, 1e-12);
}

}  // namespace
}  // namespace pincer::tasks
