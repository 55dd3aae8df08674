// The psychophysics core on cases with known answers; over thousands of observers: `pincer bench study`.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tasks/judge/bench/study_bench.h"
#include "pincer/tasks/lab/study/counterbalance.h"
#include "pincer/tasks/lab/study/known_observer.h"
#include "pincer/tests/support/effort.h"

namespace pincer::tasks {
namespace {

TEST(Staircase, FollowsLevittsTransformedRule) {
  Staircase s({.start = 10, .large_step = 4, .small_step = 1, .large_reversals = 1, .reversals = 4, .averaged = 2});
  // right right: down by 4; wrong: up, a reversal, by then in small steps; and so on.
  const std::vector<std::pair<bool, double>> story{{true, 10}, {true, 6},  {true, 6}, {false, 7}, {true, 7},
                                                   {true, 6},  {false, 7}, {true, 7}, {true, 6}};
  for (const auto& [answer, level_after] : story) {
    ASSERT_FALSE(s.over());
    s.answer(answer);
    EXPECT_DOUBLE_EQ(s.level(), level_after);
  }
  EXPECT_EQ(s.reversals(), (std::vector<double>{6, 7, 6, 7}));
  EXPECT_TRUE(s.over());
  EXPECT_DOUBLE_EQ(s.threshold(), 6.5);
}

TEST(Staircase, StaysWithinItsBoundsAndEndsWithoutAThresholdWhereThereIsNone) {
  Staircase s({.start = 1, .large_step = 0.5, .lowest = 0.25, .highest = 2, .most_trials = 50});
  while (!s.over()) {
    s.answer(true);
    EXPECT_GE(s.level(), 0.25);
  }
  EXPECT_EQ(s.trials(), 50);
  EXPECT_TRUE(std::isnan(s.threshold()));
}

TEST(Counterbalance, AReducedSquareHasItsFirstRowAndColumnInOrder) {
  const auto rows = reducedLatinSquare(4);
  for (int k = 0; k < 4; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_EQ(rows[0][at], k);
    EXPECT_EQ(rows[at][0], k);
    Order sorted = rows[at], column;
    std::sort(sorted.begin(), sorted.end());
    for (const Order& row : rows) column.push_back(row[at]);
    std::sort(column.begin(), column.end());
    EXPECT_EQ(sorted, (Order{0, 1, 2, 3}));
    EXPECT_EQ(column, (Order{0, 1, 2, 3}));
  }
}

TEST(Staircase, NamesWhatIsWrongWithARule) {
  EXPECT_EQ(problemWith({}), "");
  EXPECT_EQ(problemWith({.small_step = -0.1}), "small_step = -0.1 is out of range (0, inf)");
  EXPECT_EQ(problemWith({.reversals = 4, .averaged = 6}), "averaged = 6 is out of range [1, reversals]");
}

TEST(Staircase, SettlesWhereNRightAnswersInARowAreAsLikelyAsNot) {
  EXPECT_NEAR(convergencePoint(2), 0.7071, 1e-4);  // the 70.7 % of Levitt (1971), table I
  EXPECT_NEAR(convergencePoint(3), 0.7937, 1e-4);
}

// Abramowitz & Stegun, table 26.1 and 26.5.
TEST(Psychometric, KnowsTheNormalDistribution) {
  EXPECT_NEAR(normalCdf(1), 0.8413447461, 1e-10);
  EXPECT_NEAR(normalQuantile(0.975), 1.9599639845, 1e-10);
  EXPECT_NEAR(normalQuantile(0.5), 0, 1e-15);
}

TEST(Psychometric, LevelOfUndoesAt) {
  for (const Sigmoid shape : {Sigmoid::kLogistic, Sigmoid::kNormal}) {
    const PsychometricFunction f{shape, 3, 0.7, 0.5, 0.02};
    for (const double p : {0.55, 0.707, 0.9}) EXPECT_NEAR(f.at(f.levelOf(p)), p, 1e-12);
  }
}

// Counts that are exactly what the function expects have their most likely
// function there, whatever the noise of real ones.
TEST(Psychometric, FindsTheFunctionBehindNoiselessCounts) {
  const PsychometricFunction truth{Sigmoid::kLogistic, 2, 0.5, 0.5, 0};
  std::vector<LevelCount> counts;
  for (double x = 0; x <= 4; x += 0.5)
    counts.push_back({x, static_cast<int>(std::lround(1e6 * truth.at(x))), 1'000'000});
  const PsychometricFit fit = fitPsychometric(counts, Sigmoid::kLogistic, 0.5, 0.75);
  EXPECT_NEAR(fit.threshold, 2, 1e-3);  // counts rounded to 1e-6, golden section to 5e-7 of the range of 12
  EXPECT_NEAR(fit.function.beta, 0.5, 1e-3);
  EXPECT_EQ(fit.function.lambda, 0);
  EXPECT_LT(fit.interval.low, fit.threshold);
  EXPECT_GT(fit.interval.high, fit.threshold);
}

// At one true proportion the profile is the binomial likelihood itself: its interval is known in closed form for 50 of
// 100 ... here the width scales with 1 / sqrt(trials).
TEST(Psychometric, IntervalsShrinkWithTheRootOfTheTrials) {
  const PsychometricFunction truth{Sigmoid::kNormal, 1, 0.4, 0.5, 0};
  const auto width = [&](int trials) {
    std::vector<LevelCount> counts;
    for (const double x : {0.4, 0.7, 1.0, 1.3, 1.6, 2.2})
      counts.push_back({x, static_cast<int>(std::lround(trials * truth.at(x))), trials});
    const PsychometricFit fit = fitPsychometric(counts, Sigmoid::kNormal, 0.5, 0.75);
    return fit.interval.high - fit.interval.low;
  };
  EXPECT_NEAR(width(1000) / width(100'000), 10, 0.5);  // to first order in 1 / sqrt(trials): 1/sqrt(1000) is 3 %
}

TEST(Counterbalance, SquaresFollowWilliams) {
  EXPECT_EQ(carryOverSquare(1), (std::vector<Order>{{0}}));
  EXPECT_EQ(carryOverSquare(4), (std::vector<Order>{{0, 1, 3, 2}, {1, 2, 0, 3}, {2, 3, 1, 0}, {3, 0, 2, 1}}));
  EXPECT_EQ(carryOverSquare(3).size(), 6u);
}

// Every promise of `pincer bench study`, on as many observers as the issue asks for.
TEST(StudyBench, KeepsItsPromises) {
  int promises = 0;
  for (const Measurement& m : studyMeasurements({.observers = 1000})) {
    if (matches(m.name, "constant-stimuli")) continue;  // thousands of fits: below
    ++promises;
    MeasureContext context;
    for (const Record& r : m.run(context)) EXPECT_TRUE(r.ok) << m.name << ": " << r.metric << " = " << r.value;
  }
  EXPECT_GE(promises, 6);
}

TEST(StudyBench, IntervalsHoldTheThresholdAsOftenAsTheySay) {
  const int observers = tests::draws(200, 10);
  int judged = 0;
  for (const Measurement& m : studyMeasurements({.observers = observers})) {
    if (m.name != "constant-stimuli/logistic") continue;
    ++judged;
    MeasureContext context;
    const auto records = m.run(context);
    EXPECT_LE(records[0].value, 2);        // % of the threshold
    EXPECT_NEAR(records[1].value, 95, 5);  // 3 SD of the share of 200: 4.6 %
  }
  EXPECT_EQ(judged, 1);
}

}  // namespace
}  // namespace pincer::tasks
