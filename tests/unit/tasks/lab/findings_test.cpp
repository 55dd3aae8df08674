// Do the published findings follow: known answers and counts, the verdicts that belong to them, and many sessions that go on where they were left.
#include "pincer/tasks/lab/findings/findings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pincer/tasks/lab/findings/published_figures.h"
#include "pincer/tasks/lab/sessions/session_runs.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::errorOf;
using tests::TemporaryDirectory;

struct Thresholds {
  std::vector<double> whole, front_end;  // one per person [ms]
  bool at_chance = false;
};

// Staircases that turn 10 ms below and above a person's threshold, over and over.
std::string writeDelays(const std::string& path, const Thresholds& of) {
  SessionInfo info;
  info.task = "delay-discrimination";
  info.protocol_json = studyJson(delayStudy());
  SessionWriter writer = SessionWriter::create(path, info);
  ResponseRecord r;
  r.outcome = "answered";
  for (std::size_t person = 0; person < of.whole.size(); ++person) {
    for (const char* condition : {"whole", "front-end"}) {
      const double threshold = condition == std::string("whole") ? of.whole[person] : of.front_end[person];
      for (int k = 0; k < 20; ++k) {
        r.participant = static_cast<std::int64_t>(person);
        r.condition = condition;
        r.level = 1e-3 * (threshold + (k % 2 ? 10 : -10));
        r.correct = of.at_chance ? k % 2 : k % 4 != 0;
        r.reversal = k >= 6;
        writer.finishResponse(r);
        ++r.trial;
      }
    }
  }
  writer.close();
  return path;
}

PublishedFindings findingsOf(const TemporaryDirectory& dir, const Thresholds& thresholds, int experiments) {
  std::vector<std::string> paths;
  for (int e = 0; e < experiments; ++e) paths.push_back(writeDelays(dir / fmt::format("{}.db", e), thresholds));
  PublishedFindings findings;
  judgeStudy(paths, findings);
  return findings;
}

// Published: 61 ms whole, 132 ms front end. 61 +- 24.8 ms holds the one, 264 +- 24.8 ms is twice the other.
TEST(PublishedFigures, FollowWhereTheIntervalOverPeopleHoldsThePublishedOne) {
  const TemporaryDirectory dir;
  const PublishedFindings findings = findingsOf(dir, {{51, 61, 71}, {274, 254, 264}}, 4);
  ASSERT_EQ(findings.figures.size(), 2u);
  const PublishedFigure &whole = findings.figures[0], &front_end = findings.figures[1];
  EXPECT_NEAR(whole.mean.mean, 61, 1e-9);
  EXPECT_NEAR(whole.mean.half_width, 0, 1e-9);  // the same in every experiment
  EXPECT_EQ(whole.within, 4);
  EXPECT_EQ(verdictOn(whole), "follows");
  EXPECT_EQ(front_end.within, 0);
  EXPECT_EQ(verdictOn(front_end), "no: 2 times");
}

TEST(PublishedFigures, HaveNoVerdictOnAFewExperimentsNorWherePeopleGuessed) {
  const TemporaryDirectory few, guessed;
  EXPECT_EQ(verdictOn(findingsOf(few, {{51, 61, 71}, {51, 61, 71}}, 3).figures[0]), "too few experiments");
  EXPECT_EQ(verdictOn(findingsOf(guessed, {{51, 61, 71}, {51, 61, 71}, true}, 4).figures[0]), "no threshold");
}

// Everybody notices the front end's delay 1 ms later, though people differ by 10: paired it is certain (t = 17), else nobody could tell (t = 0.12).
TEST(PublishedOrders, AreJudgedWithinPeople) {
  const TemporaryDirectory dir, reversed;
  const Thresholds later{{51, 61, 71}, {52, 62.1, 71.9}};
  const PublishedFindings findings = findingsOf(dir, later, 4);
  ASSERT_EQ(findings.orders.size(), 1u);
  EXPECT_EQ(findings.orders[0].holds, 4);
  EXPECT_EQ(findings.orders[0].significant, 4);
  EXPECT_EQ(verdictOn(findings.orders[0]), "follows");
  const PublishedOrder other = findingsOf(reversed, {later.front_end, later.whole}, 4).orders[0];
  EXPECT_EQ(other.significant, 0);
  EXPECT_EQ(verdictOn(other), "the other way round");
}

// People who need `force` squeezes per sphere without the display and `cld` with it, all in the same time.
std::string writePickups(const std::string& path, const std::vector<int>& force, const std::vector<int>& cld, bool whole = true) {
  SessionInfo info;
  info.task = "manipulation";
  info.participants_hash = "0123456789abcdef";
  SessionWriter writer = SessionWriter::create(path, info);
  TrialRecord t;
  t.outcome = "success";
  t.duration = 10;
  for (std::size_t person = 0; person < force.size(); ++person) {
    for (const bool display : {false, true}) {
      t.participant = static_cast<std::int64_t>(person);
      t.condition = display ? "cld+force" : "force";
      t.squeezes = display ? cld[person] : force[person];
      writer.finishTrial(t);
      ++t.trial;
    }
  }
  whole ? writer.close() : writer.abort("interrupted");
  return path;
}

const FindingResult& resultOf(const VariantResult& variant, const std::string& key) {
  for (std::size_t m = 0; m < variant.findings.size(); ++m) {
    if (findingMeasures()[m].key == key) return variant.findings[m];
  }
  throw std::logic_error("no measure " + key);
}

std::string verdictOn(const VariantResult& variant, const std::string& key) {
  const auto& measures = findingMeasures();
  const auto measure = std::find_if(measures.begin(), measures.end(), [&](const FindingMeasure& m) { return m.key == key; });
  return verdictOn(*measure, resultOf(variant, key));
}

// Fewer squeezes by 2, 1, 2, 1: t = -1.5 / (0.577 / 2) = -5.2, p = 0.014. Of five such experiments, five are certainly more than half.
TEST(Findings, FollowWhereMostExperimentsShowThem) {
  const TemporaryDirectory dir;
  std::vector<std::string> sessions;
  for (int e = 0; e < 5; ++e) sessions.push_back(writePickups(dir / fmt::format("{}.db", e), {3, 4, 5, 6}, {1, 3, 3, 5}));
  sessions.push_back(writePickups(dir / "unfinished.db", {9, 9, 9, 9}, {1, 1, 1, 2}, false));
  const VariantResult primary = judgeVariant(findingsVariants().front(), sessions);
  EXPECT_EQ(primary.hash, "0123456789abcdef");
  const FindingResult& squeezes = resultOf(primary, "tries");
  EXPECT_EQ(squeezes.experiments, 5);  // the unfinished one is left out
  EXPECT_NEAR(squeezes.force.mean, 4.5, 1e-12);
  EXPECT_NEAR(squeezes.difference.mean, -1.5, 1e-12);
  EXPECT_NEAR(squeezes.effect.mean, -1.5 / std::sqrt(1.0 / 3), 1e-12);
  EXPECT_EQ(squeezes.significant_less, 5);
  EXPECT_EQ(verdictOn(primary, "tries"), "follows");
  sessions.resize(3);
  EXPECT_EQ(verdictOn(judgeVariant(findingsVariants().front(), sessions), "tries"), "too few experiments");
}

TEST(Findings, DoNotFollowWhereTheyGoTheOtherWay) {
  const TemporaryDirectory dir;
  std::vector<std::string> sessions;
  for (int e = 0; e < 5; ++e) sessions.push_back(writePickups(dir / fmt::format("{}.db", e), {1, 3, 3, 5}, {3, 4, 5, 6}));
  const VariantResult primary = judgeVariant(findingsVariants().front(), sessions);
  EXPECT_EQ(resultOf(primary, "tries").significant_t, 5);
  EXPECT_EQ(verdictOn(primary, "tries"), "does not follow");
}

TEST(Findings, EveryExperimentHasItsOwnPeopleAndEveryVariantTheSame) {
  const FindingsOptions options;
  const auto& variants = findingsVariants();
  EXPECT_NE(experimentOf(options, variants[0], 0).seed, experimentOf(options, variants[0], 1).seed);
  for (const FindingsVariant& variant : variants) {
    EXPECT_EQ(experimentOf(options, variant, 3).seed, experimentOf(options, variants[0], 3).seed) << variant.name;
  }
}

// What a run that was killed left behind: one whole session, one begun, one not there.
TEST(SessionRuns, TakeWhatIsWholeAndGoOnWithWhatIsBegun) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "manipulation";
  std::vector<std::string> ran;
  std::vector<SessionRun> runs;
  for (const char* name : {"whole", "begun", "new"}) {
    runs.push_back(
        {dir / name, info, [&ran, name](bool resume, const ShareDone&) { ran.push_back(name + std::string(resume ? " on" : "")); }});
  }
  SessionWriter::create(dir / "whole", info).close();
  SessionWriter::create(dir / "begun", info).abort("killed");
  std::int64_t done = 0, total = 0;
  const std::atomic<bool> no{false};
  runSessions(runs, 1, no, [&](std::int64_t d, std::int64_t t) { done = d, total = t; });
  EXPECT_EQ(ran, (std::vector<std::string>{"begun on", "new"}));
  EXPECT_EQ(done, 3000);
  EXPECT_EQ(total, 3000);
}

TEST(SessionRuns, RefuseASessionOfSomethingElseBeforeAnythingRuns) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "manipulation";
  info.protocol_json = "12 participants";
  SessionWriter::create(dir / "b", info).close();
  bool ran = false;
  std::vector<SessionRun> runs;
  info.protocol_json = "6 participants";
  for (const char* name : {"a", "b"}) runs.push_back({dir / name, info, [&](bool, const ShareDone&) { ran = true; }});
  const std::atomic<bool> no{false};
  const std::string error = errorOf([&] { runSessions(runs, 2, no, {}); });
  EXPECT_TRUE(contains(error, "another design") && contains(error, "--out")) << error;
  EXPECT_FALSE(ran);
}

}  // namespace
}  // namespace pincer::tasks
