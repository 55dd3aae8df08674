#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "pincer/tasks/lab/report/figures.h"
#include "pincer/tasks/lab/report/summary.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::TemporaryDirectory;

TrialRecord trialOf(std::int64_t participant, const char* condition, double mu, std::int64_t squeezes, double duration,
                    const char* outcome = "success") {
  static std::int64_t next = 0;
  TrialRecord t;
  t.trial = next++;
  t.participant = participant;
  t.condition = condition;
  t.mu_s = mu;
  t.squeezes = squeezes;
  t.duration = duration;
  t.outcome = outcome;
  return t;
}

SessionSummary summaryOf(const std::vector<TrialRecord>& trials) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.seed = 3;
  auto writer = SessionWriter::create(dir / "a.db", info);
  for (const TrialRecord& t : trials) writer.finishTrial(t);
  writer.close();
  return summariseSession(SessionReader(dir / "a.db"));
}

TEST(SessionSummary, HasACellPerConditionAndFrictionAndOneForAll) {
  const auto s = summaryOf({trialOf(0, "cld+force", 0.9, 1, 4), trialOf(0, "force", 0.9, 2, 6),
                            trialOf(0, "force", 0.3, 5, 9), trialOf(0, "force", 0.3, 3, 7)});
  EXPECT_EQ(s.conditions, (std::vector<std::string>{"force", "cld+force"}));
  EXPECT_EQ(s.frictions, (std::vector<double>{0.3, 0.9}));
  ASSERT_EQ(s.cells.size(), 5u);  // force 0.3, 0.9, all; cld+force 0.9, all
  EXPECT_EQ(s.cells[0].trials, 2);
  EXPECT_DOUBLE_EQ(s.cells[0].measures[kSqueezes].mean, 4);
  EXPECT_DOUBLE_EQ(s.cells[0].measures[kTime].mean, 8);
  EXPECT_NEAR(s.cells[0].measures[kTime].half_width, 12.706, 5e-4);  // t(1) * sqrt(2) / sqrt(2), from the printed table
  EXPECT_TRUE(s.cells[2].allFrictions());
  EXPECT_DOUBLE_EQ(s.cells[2].measures[kSqueezes].mean, 10.0 / 3);
  EXPECT_EQ(s.cells[3].measures[kSqueezes].n, 1);
}

// Two people with three and one trials count alike.
TEST(SessionSummary, CountsEachParticipantOnce) {
  const auto s = summaryOf({trialOf(0, "force", 0.3, 1, 1), trialOf(0, "force", 0.3, 2, 1),
                            trialOf(0, "force", 0.3, 3, 1), trialOf(1, "force", 0.3, 6, 1)});
  EXPECT_EQ(s.participants, 2);
  EXPECT_EQ(s.cells[0].measures[kSqueezes].n, 2);
  EXPECT_DOUBLE_EQ(s.cells[0].measures[kSqueezes].mean, 4);
  EXPECT_NE(tableNote(s).find("participants' means"), std::string::npos);
}

TEST(SessionSummary, MarksTimeOutsAndLeavesFaultsOut) {
  const auto s = summaryOf({trialOf(0, "force", 0.3, 2, 10), trialOf(0, "force", 0.3, 4, 60, "timeout"),
                            trialOf(0, "force", 0.3, 99, 1, "fault")});
  EXPECT_EQ(s.cells[0].trials, 3);
  EXPECT_EQ(s.cells[0].timeouts, 1);
  EXPECT_EQ(s.cells[0].faults, 1);
  EXPECT_DOUBLE_EQ(s.cells[0].measures[kSqueezes].mean, 3);
  EXPECT_DOUBLE_EQ(s.cells[0].successRate(), 1.0 / 3);
  const std::string text = formatTable(s);
  EXPECT_NE(text.find("≥ 3.00"), std::string::npos) << text;
  EXPECT_NE(text.find("lower bounds"), std::string::npos) << text;
  EXPECT_NE(text.find("left out"), std::string::npos) << text;
}

// People with one squeeze each had the interval "1.00 to 1.00", as if nothing else could come out.
TEST(SessionSummary, GivesEqualValuesNoInterval) {
  const std::string text = formatTable(summaryOf({trialOf(0, "force", 0.3, 1, 10), trialOf(1, "force", 0.3, 1, 12)}));
  EXPECT_EQ(text.find("1.00 to 1.00"), std::string::npos) << text;
  EXPECT_NE(text.find(" to "), std::string::npos) << "their times differ, and have one: " << text;
}

TEST(SessionSummary, PrintsAlignedColumns) {
  const std::string text =
      formatTable(summaryOf({trialOf(0, "force", 0.3, 2, 10), trialOf(0, "cld+force", 0.3, 1, 123)}));
  std::size_t width = 0;
  std::istringstream lines(text);
  std::string line;
  for (int row = 0; row < 5 && std::getline(lines, line); ++row) {
    const auto characters =
        static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }));
    if (row == 0) width = characters;
    EXPECT_EQ(characters, width) << line;
  }
}

TEST(SessionSummary, IsNothingButHonestForAnEmptySession) {
  const auto s = summaryOf({});
  EXPECT_EQ(s.trials, 0);
  EXPECT_TRUE(s.cells.empty());
  EXPECT_NO_THROW(formatTable(s));
  EXPECT_EQ(nlohmann::json::parse(summaryJson(s))["cells"].size(), 0u);
}

TEST(SessionSummary, IsJsonForMachines) {
  const auto json =
      nlohmann::json::parse(summaryJson(summaryOf({trialOf(0, "force", 0.3, 2, 10), trialOf(0, "force", 0.3, 4, 11)})));
  EXPECT_EQ(json["seed"], 3);
  EXPECT_EQ(json["state"], "complete");
  EXPECT_EQ(json["cells"][0]["mu_s"], 0.3);
  EXPECT_EQ(json["cells"][0]["squeezes"]["mean"], 3);
  EXPECT_EQ(json["cells"][0]["squeezes"]["n"], 2);
  EXPECT_TRUE(json["cells"][1]["mu_s"].is_null());
}

TEST(RepresentativeTrial, HasTheMedianNumberOfSqueezes) {
  const std::vector<TrialRecord> trials{trialOf(0, "force", 0.3, 9, 1),          trialOf(0, "force", 0.3, 2, 1),
                                        trialOf(0, "force", 0.3, 3, 1),          trialOf(0, "force", 0.3, 3, 1),
                                        trialOf(0, "force", 0.3, 1, 1, "fault"), trialOf(0, "other", 0.3, 1, 1)};
  const auto chosen = representativeTrial(trials, "force");
  ASSERT_TRUE(chosen.has_value());
  EXPECT_EQ(chosen->trial, trials[2].trial);  // 2 3 3 9: the lower middle is 3, and its earliest trial is chosen
  EXPECT_FALSE(representativeTrial(trials, "absent").has_value());
}

TEST(SummaryJson, HoldsNothingThatATerminalObeys) {
  const std::string text = summaryJson(summaryOf({trialOf(0, "a\x7f\x1b[31m\xc2\x9b", 0.3, 2, 10)}));
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7f)) << static_cast<int>(c);
  EXPECT_NE(text.find("a\\u007f\\u001b[31m\\u009b"), std::string::npos) << text;
}

}  // namespace
}  // namespace pincer::tasks
