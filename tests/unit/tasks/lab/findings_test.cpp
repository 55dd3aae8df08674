// Do the published findings follow: known answers and counts, the verdicts that belong to them, and many
// sessions that go on where they were left.
#include "pincer/tasks/lab/findings/findings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "pincer/tasks/lab/findings/claim_judge.h"
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

ClaimTable tableOf(const TemporaryDirectory& dir, const Thresholds& thresholds, int studies) {
  std::vector<std::string> paths;
  for (int e = 0; e < studies; ++e) paths.push_back(writeDelays(dir / fmt::format("{}.db", e), thresholds));
  return judgeClaims({{{"delay-discrimination", paths}}, {}, {}});
}

const ClaimRow& rowOf(const ClaimTable& table, const std::string& id) {
  return *std::find_if(table.rows.begin(), table.rows.end(), [&](const ClaimRow& row) { return row.claim->id == id; });
}

std::string verdictOn(const ClaimTable& table, const std::string& id) {
  const ClaimRow& row = rowOf(table, id);
  return verdictOn(*row.claim, row.evidence);
}

// Published: 61 +- 15 ms whole, 132 +- 15 ms front end. 61 +- 24.8 ms hits the one and is narrow enough (24.8
// < 30), 264 +- 24.8 ms is twice the other.
TEST(Claims, AFigureFollowsWhereStudiesHitIt) {
  const TemporaryDirectory dir;
  const ClaimTable table = tableOf(dir, {{51, 61, 71}, {274, 254, 264}}, 4);
  const ClaimEvidence& whole = rowOf(table, "F35").evidence;
  EXPECT_NEAR(whole.mean_a, 61, 1e-9);
  EXPECT_NEAR(whole.own_half, 24.84, 0.01);  // t of two degrees of freedom, 4.303, times 10 / sqrt 3
  EXPECT_EQ(whole.hits, 4);
  EXPECT_EQ(verdictOn(table, "F35"), "follows");
  EXPECT_EQ(rowOf(table, "F36").evidence.hits, 0);
  EXPECT_EQ(verdictOn(table, "F36"), "does not follow: 2 times");
  EXPECT_EQ(verdictOn(table, "F1"), "not run");
  EXPECT_EQ(verdictOn(table, "F48"), "-");
}

// Noisy people don't follow the more easily: 61 +- 50 ms hits in every study, but is three
// times as wide as the published interval.
TEST(Claims, AFigureOfNoisyPeopleOnlyLooksTheSame) {
  const TemporaryDirectory dir;
  EXPECT_EQ(verdictOn(tableOf(dir, {{41, 61, 81}, {132, 132, 132}}, 5), "F35"), "would mostly look the same");
}

TEST(Claims, HaveNoVerdictOnAFewStudiesNorAFigureWherePeopleGuessed) {
  const TemporaryDirectory few, guessed;
  EXPECT_EQ(verdictOn(tableOf(few, {{51, 61, 71}, {51, 61, 71}}, 3), "F35"), "too few studies");
  EXPECT_EQ(verdictOn(tableOf(guessed, {{51, 61, 71}, {51, 61, 71}, true}, 4), "F35"), "does not follow: no threshold");
}

// Everybody notices the front end's delay 1 ms later, though people differ by 10: within people certain (t = 17), by
// the published unpaired test not (t = 0.12).
TEST(Claims, AnOrderIsJudgedByThePublishedTestWithAPairedOneBeside) {
  const TemporaryDirectory dir, clear, reversed;
  const Thresholds later{{51, 61, 71}, {52, 62.1, 71.9}};
  const ClaimTable table = tableOf(dir, later, 5);
  EXPECT_EQ(rowOf(table, "F37").evidence.that_way, 5);
  EXPECT_EQ(rowOf(table, "F37").evidence.significant, 0);
  EXPECT_EQ(rowOf(table, "F37").evidence.paired, 5);
  EXPECT_EQ(verdictOn(table, "F37"), "same direction only");
  EXPECT_EQ(verdictOn(tableOf(clear, {{51, 61, 71}, {132, 142, 122}}, 5), "F37"), "follows");
  EXPECT_EQ(verdictOn(tableOf(reversed, {later.front_end, later.whole}, 5), "F37"), "reversed");
}

TEST(Claims, ANullFollowsWithinItsMarginOnly) {
  Claim null{"F0", "", ClaimKind::kNull, "", ""};
  null.margin_kind = MarginKind::kDifference;
  null.margin = 5;
  ClaimEvidence e;
  e.studies = 20;
  e.difference = 2;
  e.difference_half = 2;
  EXPECT_EQ(verdictOn(null, e), "follows");
  e.difference_half = 4;
  EXPECT_EQ(verdictOn(null, e), "would mostly look the same");
  e.significant = 18;
  EXPECT_EQ(verdictOn(null, e), "does not follow");
  e.significant = 10;
  EXPECT_EQ(verdictOn(null, e), "can't be told");
  null.margin_kind = MarginKind::kRatio;  // ln 1.5 = 0.405
  null.margin = 1.5;
  e.difference = 0.3;
  e.difference_half = 0.1;
  EXPECT_EQ(verdictOn(null, e), "follows");
}

// A pilot's best verdict, and figures that people's limits came from.
TEST(Claims, PilotsAndCalibrationsNeverFollow) {
  ClaimEvidence e;
  e.studies = e.that_way = e.significant = e.significant_that_way = e.hits = 20;
  Claim claim{"F0", "", ClaimKind::kOrder, "", ""};
  claim.test = ClaimTest::kStudent;
  EXPECT_EQ(verdictOn(claim, e), "follows");
  claim.mark = ClaimMark::kPilot;
  EXPECT_EQ(verdictOn(claim, e), "same direction only");
  claim.mark = ClaimMark::kCalibration;
  EXPECT_EQ(verdictOn(claim, e), "calibration");
}

// F1 .. F48, each once (a, b, t: parts of one), each with what its kind needs.
TEST(Claims, AreAllThere) {
  std::set<int> numbers;
  std::set<std::string> ids;
  for (const Claim& c : publishedClaims()) {
    EXPECT_TRUE(ids.insert(c.id).second) << c.id;
    numbers.insert(std::stoi(std::string(c.id).substr(1)));
    EXPECT_TRUE(c.kind != ClaimKind::kNull || c.margin > 0) << c.id;
    EXPECT_TRUE(c.kind != ClaimKind::kFigure || c.mean > 0) << c.id;
  }
  EXPECT_EQ(numbers.size(), 48u);
  EXPECT_EQ(*numbers.rbegin(), 48);
}

TEST(Claims, RefusePartsOfTwoCommits) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "delay-discrimination";
  info.protocol_json = studyJson(delayStudy());
  for (const char* commit : {"a", "b"}) {
    info.commit = commit;
    SessionWriter::create(dir / commit, info).close();
  }
  const std::string error = errorOf([&] { judgeClaims({{{"delay-discrimination", {dir / "a", dir / "b"}}}, {}, {}}); });
  EXPECT_TRUE(contains(error, "another commit") && contains(error, "--out")) << error;
}

// People who need `force` squeezes per sphere without the display and `cld` with it, all in the same time.
std::string writePickups(const std::string& path, const std::vector<int>& force, const std::vector<int>& cld,
                         bool whole = true) {
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
  const auto measure =
      std::find_if(measures.begin(), measures.end(), [&](const FindingMeasure& m) { return m.key == key; });
  return verdictOn(*measure, resultOf(variant, key));
}

// Fewer squeezes by 2, 1, 2, 1: t = -1.5 / (0.577 / 2) = -5.2, p = 0.014. Of five such
// experiments, five are certainly more than half.
TEST(Findings, FollowWhereMostExperimentsShowThem) {
  const TemporaryDirectory dir;
  std::vector<std::string> sessions;
  for (int e = 0; e < 5; ++e)
    sessions.push_back(writePickups(dir / fmt::format("{}.db", e), {3, 4, 5, 6}, {1, 3, 3, 5}));
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
  for (int e = 0; e < 5; ++e)
    sessions.push_back(writePickups(dir / fmt::format("{}.db", e), {1, 3, 3, 5}, {3, 4, 5, 6}));
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

// Remains of a run that was killed: one whole session, one begun, one not there.
TEST(SessionRuns, TakeWhatIsWholeAndGoOnWithWhatIsBegun) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "manipulation";
  std::vector<std::string> ran;
  std::vector<SessionRun> runs;
  for (const char* name : {"whole", "begun", "new"}) {
    runs.push_back({dir / name, info, [&ran, name](bool resume, const ShareDone&) {
                      ran.push_back(name + std::string(resume ? " on" : ""));
                    }});
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
