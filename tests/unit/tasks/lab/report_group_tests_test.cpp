// Distributions and tests of groups: printed tables, closed forms, a certified data set, and what
// the dissertation printed of its own tests.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "pincer/tasks/lab/report/distributions.h"
#include "pincer/tasks/lab/report/group_tests.h"
#include "pincer/tasks/lab/report/paired_test.h"

namespace pincer::tasks {
namespace {

// Upper 5 % points of F as printed (Abramowitz & Stegun 1964, table 26.9), two decimals: half a unit of the
// last times the density there, at most 1.
TEST(FTail, IsWhatThePrintedTableSays) {
  const struct {
    double m, n, f;
  } table[] = {{1, 5, 6.61}, {3, 10, 3.71}, {3, 40, 2.84}, {4, 20, 2.87}, {10, 10, 2.98}, {4, 120, 2.45}};
  for (const auto& row : table) EXPECT_NEAR(fTail(row.f, row.m, row.n), 0.05, 5e-4) << row.m << ", " << row.n;
}

// Closed forms: of two degrees of freedom above, P = (1 + 2 f / n)^(-n/2); of one, Student's t. 1e-12: the
// continued fraction's 1e-15 and ln Gamma's 1e-14.
RC_GTEST_PROP(FTail, IsClosedForOneAndTwoDegreesOfFreedom, ()) {
  const int n = *rc::gen::inRange(1, 200);
  const double f = *rc::gen::map(rc::gen::inRange(1, 2000), [](int k) { return k / 100.0; });
  RC_ASSERT(std::abs(fTail(f, 2, n) - std::pow(1 + 2 * f / n, -0.5 * n)) <= 1e-12);
  RC_ASSERT(std::abs(fTail(f, 1, n) - (1 - studentTwoSided(std::sqrt(f), n))) <= 1e-11);
  RC_ASSERT(std::abs(studentTail(std::sqrt(f), n) - fTail(f, 1, n)) <= 1e-12);
}

// Tests as ch. 2 and 3 of the dissertation print them, to the digits printed (F = 0.5 alone
// has one digit: .48 to .55 make .75 to .70).
TEST(FTail, IsWhatTheDissertationPrintsOfItsTests) {
  EXPECT_NEAR(studentTail(1.53, 502), 0.127, 5e-4);
  EXPECT_NEAR(fTail(0.5, 4, 995), 0.733, 5e-3);
  EXPECT_LT(fTail(18.92, 4, 995), 0.001);
  EXPECT_NEAR(fTail(9.38, 1, 38), 0.004, 5e-4);
  EXPECT_LT(fTail(49.89, 1, 38), 0.001);
}

// Upper 5 % and 1 % points of the studentized range as printed (E. S. Pearson, H. O. Hartley,
// Biometrika Tables I, table 29), two decimals.
TEST(StudentizedRange, IsWhatThePrintedTableSays) {
  const struct {
    int k;
    double n, q, p;
  } table[] = {{2, 10, 3.15, .05}, {3, 10, 3.88, .05}, {4, 20, 3.96, .05},
               {4, 40, 3.79, .05}, {5, 60, 3.98, .05}, {3, 20, 4.64, .01}};
  for (const auto& row : table)
    EXPECT_NEAR(studentizedRangeTail(row.q, row.k, row.n), row.p, 0.02 * row.p) << row.k << ", " << row.n;
}

// Of two means it is Student's t times sqrt 2. 1e-6: Simpson's rule.
RC_GTEST_PROP(StudentizedRange, OfTwoMeansIsStudents, ()) {
  const int n = *rc::gen::inRange(3, 100);
  const double q = *rc::gen::map(rc::gen::inRange(0, 80), [](int k) { return k / 10.0; });
  RC_ASSERT(std::abs(studentizedRangeTail(q, 2, n) - studentTail(q / std::sqrt(2.0), n)) <= 1e-6);
}

// Data set SiRstv of NIST's Statistical Reference Datasets (five instruments, five readings of a
// resistivity): certified F = 1.18046237440255, residual mean square 0.0108365772. Six digits of the
// data are common to all, so 1e-9 of F's 16.
TEST(OneWayVariance, IsTheCertifiedFigure) {
  const Groups groups = {{196.3052, 196.1240, 196.1890, 196.2569, 196.3403},
                         {196.3042, 196.3825, 196.1669, 196.3257, 196.0422},
                         {196.1303, 196.2005, 196.2889, 196.0343, 196.1811},
                         {196.2795, 196.1748, 196.1494, 196.1485, 195.9885},
                         {196.2119, 196.1051, 196.1850, 196.0052, 196.2090}};
  const VarianceTest test = oneWayVariance(groups);
  EXPECT_NEAR(test.f, 1.18046237440255, 1e-9);
  EXPECT_EQ(test.between_dof, 4);
  EXPECT_EQ(test.within_dof, 20);
}

// Of two conditions F is the square of the paired t, and of two groups the square of Student's.
TEST(RepeatedMeasures, OfTwoConditionsIsThePairedTest) {
  const std::vector<double> a = {3, 4, 7, 5, 9, 6}, b = {5, 5, 9, 4, 12, 8};
  const PairedTest paired = comparePairs(a, b);
  const VarianceTest repeated = repeatedMeasures({a, b});
  EXPECT_NEAR(repeated.p, paired.p_t, 1e-12);
  EXPECT_NEAR(repeated.f, paired.effect * paired.effect * 6, 1e-12);
  EXPECT_NEAR(oneWayVariance({a, b}).p, studentTest(a, b).p, 1e-12);
}

// By hand: conditions' means 2, 4, 6 over three people who differ by constants and by +-1 of one: residual mean square
// 1/2... with all of them the same pattern nothing is left, and a test of nothing says nothing.
TEST(RepeatedMeasures, TakesOutWhatPeopleShare) {
  EXPECT_EQ(repeatedMeasures({{1, 11, 21}, {2, 12, 22}, {4, 14, 24}}).p, 1);
  const VarianceTest test = repeatedMeasures({{1, 11, 22}, {2, 12, 21}});
  // Differences 1, 1, -1: mean 1/3, variance 4/3, t^2 = (1/9) / (4/9).
  EXPECT_NEAR(test.f, 0.25, 1e-12);
  const double gone = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(repeatedMeasures({{1, 11, 22, gone}, {2, 12, 21, 5}}).f, 0.25, 1e-12);
}

// By hand: a = 1..5, b = 2, 4, .., 10: means 3 and 6, variances 2.5 and 10; error sqrt(2.5) , t = 3
// / sqrt 2.5, dof = 2.5^2 / (0.25/4 + 4/4).
TEST(WelchTest, IsRightForTwoSmallGroups) {
  const MeansTest test = welchTest({1, 2, 3, 4, 5}, {2, 4, 6, 8, 10});
  EXPECT_DOUBLE_EQ(test.difference, 3);
  EXPECT_NEAR(test.t, 3 / std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(test.dof, 6.25 / 1.0625, 1e-12);
  EXPECT_NEAR(test.p, studentTail(test.t, test.dof), 1e-15);
}

// Of two groups Tukey's pair is Student's test.
TEST(TukeyPair, OfTwoGroupsIsStudents) {
  const std::vector<double> a = {1, 2, 3, 4, 5}, b = {2, 4, 6, 8, 10};
  EXPECT_NEAR(tukeyPair({a, b}, 0, 1), studentTest(a, b).p, 1e-6);  // Simpson's rule
  EXPECT_GT(tukeyPair({a, b, a, a}, 0, 1), studentTest(a, b).p);
}

// Mean 0.1, standard error 0.1 (n = 4): against a margin of 0.5, t = 4 and 6 of three degrees of
// freedom; the larger one-sided p is that of 4.
TEST(EquivalenceTest, TakesTheWorseOfTheTwoSides) {
  const double s = 0.1 * std::sqrt(3.0);
  const std::vector<double> d = {0.1 - s, 0.1 - s, 0.1 + s, 0.1 + s};
  EXPECT_NEAR(equivalenceTest(d, 0.5), 0.5 * studentTail(4, 3), 1e-12);
  EXPECT_GT(equivalenceTest(d, 0.05), 0.5);
}

}  // namespace
}  // namespace pincer::tasks
