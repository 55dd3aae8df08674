// Outcomes of findings, in words.
#include "pincer/tasks/lab/report/finding_words.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pincer/tests/support/run_app.h"

namespace pincer::tasks {
namespace {

using tests::contains;

// People with these squeezes per sphere, by force only and with the display.
SessionSummary pickups(const std::vector<std::pair<int, int>>& squeezes) {
  std::vector<TrialRecord> trials;
  for (std::size_t person = 0; person < squeezes.size(); ++person) {
    for (const char* condition : {"force", "cld+force"}) {
      TrialRecord t;
      t.participant = static_cast<std::int64_t>(person);
      t.condition = condition;
      t.outcome = "success";
      t.squeezes = condition == std::string("force") ? squeezes[person].first : squeezes[person].second;
      t.duration = 10;
      trials.push_back(t);
    }
  }
  SessionSummary s;
  s.info.devices_json = R"({"arms": "simulated"})";
  s.participants = static_cast<std::int64_t>(squeezes.size());
  s.conditions = {"force", "cld+force"};
  s.labels = {"force only", "CLD + force"};
  s.rows = measureRows(trials, s.conditions);
  return s;
}

// By hand: differences -1 eleven times and 0 once; exact signed-rank p = 2 / 2^11, 1 in 1024.
TEST(FindingWords, SayTheEffectItsIntervalAndHowSure) {
  std::vector<std::pair<int, int>> people(11, {3, 2});
  people.push_back({2, 2});
  const std::string words = findingWords(pickups(people)).at(0);
  EXPECT_TRUE(
      contains(words, "12 simulated people. Squeezes per sphere picked up: 2.92 by force only, 2.00 with the display"))
      << words;
  EXPECT_TRUE(contains(words, "difference -0.92 (95 % interval -1.10 to -0.73), less for 11 of 12 people")) << words;
  EXPECT_TRUE(contains(words, "less than 1 in 1000 such studies")) << words;
  EXPECT_TRUE(contains(words, "So the display lowers it.")) << words;
}

TEST(FindingWords, DontClaimWhatChanceShowsAsWell) {
  const std::string words = findingWords(pickups({{2, 3}, {3, 2}, {2, 2}, {4, 3}})).at(0);
  EXPECT_TRUE(contains(words, "So no effect of the display is shown; that isn't to say that there is none.")) << words;
}

// "95 % interval +1.00 to +1.00": as if nothing else could come out.
TEST(FindingWords, EqualDifferencesHaveNoInterval) {
  const std::string words = findingWords(pickups({{2, 3}, {4, 5}})).at(0);
  EXPECT_TRUE(contains(words, "difference +1.00 (the same for all, so no interval), more for 2 of 2 people")) << words;
}

TEST(FindingWords, OnePersonIsNoFinding) {
  const std::string words = findingWords(pickups({{5, 1}})).at(0);
  EXPECT_TRUE(contains(words, "One simulated person")) << words;
  EXPECT_TRUE(contains(words, "More people are needed for a finding.")) << words;
}

// S. Holm's procedure by hand: of 0.01, 0.04, 0.03: 0.03, 0.06, 0.06.
TEST(FindingWords, ManyLooksAreCorrectedAfterHolm) {
  const std::vector<double> adjusted = holmAdjusted({0.01, 0.04, std::nan(""), 0.03});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.03);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[3], 0.06);
  EXPECT_NE(adjusted[2], adjusted[2]);
}

}  // namespace
}  // namespace pincer::tasks
