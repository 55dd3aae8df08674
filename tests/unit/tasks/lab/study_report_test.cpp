// A study's report on answers that nobody gave: thresholds, intervals,
// verdicts, and every figure with its numbers.
#include "pincer/tasks/lab/report/study_report.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "pincer/tasks/lab/report/study_tests.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::readFile;
using tests::TemporaryDirectory;

// Two people whose staircases turn at 40 and 80 ms, and at 60 and 100 ms, over and over: thresholds of 60 and 80 ms.
void writeDelaySession(const std::string& path, bool at_chance) {
  SessionInfo info;
  info.task = "delay-discrimination";
  info.protocol_json = studyJson(delayStudy());
  info.participants_hash = "0123456789abcdef";
  SessionWriter writer = SessionWriter::create(path, info, {});
  for (std::int64_t k = 0; k < 40; ++k) {
    ResponseRecord r;
    r.trial = k;
    r.participant = k / 20;
    r.index = k % 20;
    r.condition = "whole";
    r.level = (k % 2 ? 0.080 : 0.040) + 0.020 * static_cast<double>(r.participant);
    r.correct = at_chance ? k % 2 : k % 4 != 0;
    r.reversal = k % 20 >= 6;
    r.outcome = "answered";
    r.finger_speed = 0.05;
    r.tactor_speed = std::numeric_limits<double>::quiet_NaN();
    writer.finishResponse(r);
  }
  writer.close();
}

// A study with two blocks showed the second block's threshold alone.
TEST(StudySummary, AThresholdIsTheMeanOfThoseOfAllBlocks) {
  ArcStudy study = delayStudy();
  study.conditions[0].staircase.averaged = 2;
  SessionInfo info;
  info.task = study.task;
  info.protocol_json = studyJson(study);
  std::vector<ResponseRecord> responses;
  for (std::int64_t k = 0; k < 8; ++k) {
    ResponseRecord r;
    r.run = k / 4;
    r.index = k % 4;
    r.condition = "whole";
    r.level = r.run == 0 ? 0.060 : 0.100;
    r.correct = 1;
    r.reversal = r.index >= 2;
    r.outcome = "answered";
    responses.push_back(r);
  }
  const StudySummary summary = summariseStudy(info, "two blocks", responses);
  ASSERT_EQ(summary.conditions.front().people.size(), 1u);
  EXPECT_DOUBLE_EQ(summary.conditions.front().people.front().headline, 0.080);
}

// Of a session that was interrupted at once, or whose trials all ended in a fault.
TEST(StudyReport, WithoutAnAnswerSaysWhatIsNotDrawn) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "delay-discrimination";
  info.protocol_json = studyJson(delayStudy());
  SessionWriter writer = SessionWriter::create(dir / "a.db", info, {});
  ResponseRecord r;
  r.condition = "whole";
  r.outcome = "fault";
  r.level = r.finger_speed = r.tactor_speed = r.duration = 0;
  writer.finishResponse(r);
  writer.abort("interrupted");
  const ReportFiles files = writeStudyReport(SessionReader(dir / "a.db"), dir / "r.html");
  EXPECT_FALSE(files.not_drawn.empty());
  EXPECT_TRUE(contains(readFile(files.html), "Not drawn, since no finished trial has numbers for it: "));
  const tests::AppResult result = tests::runPincer({"report", dir / "a.db"});
  EXPECT_EQ(result.exit_code, kExitOk) << result.error;
  EXPECT_FALSE(contains(result.error, "gnuplot")) << result.error;
}

TEST(StudyReport, ThresholdsAreMeansOfTheLastReversalsPerPerson) {
  const TemporaryDirectory dir;
  writeDelaySession(dir / "a.db", false);
  const SessionReader session(dir / "a.db");
  const StudySummary s = summariseStudy(session, session.responses());
  ASSERT_EQ(s.conditions.size(), 2u);
  const StudyCondition& whole = s.conditions[0];
  ASSERT_EQ(whole.people.size(), 2u);
  EXPECT_NEAR(whole.people[0].headline, 0.060, 1e-12);
  EXPECT_NEAR(whole.people[1].headline, 0.080, 1e-12);
  EXPECT_NEAR(whole.headline.mean, 0.070, 1e-12);
  // t of one degree of freedom times s / sqrt(2) = 10 ms
  EXPECT_NEAR(whole.headline.half_width, 0.010 * 12.7062, 1e-5);
  EXPECT_EQ(whole.right.mean, 0.75);
  EXPECT_EQ(s.conditions[1].trials, 0);
  const std::string table = formatStudyTable(s);
  EXPECT_TRUE(contains(table, "70.0 (11.4 to 429.9)") && contains(table, "yes")) << table;
}

// Turns of 0.9/9 and 0.9/99 rad, over and over: n = 10 and 100. The mean of n is
// 55; the n of the mean angle would be 17.5.
TEST(StudyReport, CountsSmoothnessInSegmentsAndAveragesThem) {
  const TemporaryDirectory dir;
  SessionInfo info;
  info.task = "smoothness-discrimination";
  info.protocol_json = studyJson(smoothnessStudy());
  SessionWriter writer = SessionWriter::create(dir / "a.db", info, {});
  for (std::int64_t k = 0; k < 20; ++k) {
    ResponseRecord r;
    r.trial = k;
    r.condition = "C1";
    r.level = 0.9 / (k % 2 ? 99 : 9);
    r.correct = k % 4 != 0;
    r.reversal = k >= 9;
    r.outcome = "answered";
    writer.finishResponse(r);
  }
  writer.close();
  const SessionReader session(dir / "a.db");
  const StudySummary s = summariseStudy(session, session.responses());
  EXPECT_NEAR(s.conditions[0].headline.mean, 55, 1e-9);
  EXPECT_NEAR(levelShown(s, 55), 180 / M_PI * 0.9 / 54, 1e-12);
  const std::string table = formatStudyTable(s);
  EXPECT_TRUE(contains(table, "threshold [segments]") && contains(table, "55.00 (0.95°)") && contains(table, "104"))
      << table;
}

// 1, 2, 3 against 4, 5, 7 of the same people: F(1, 4) = 10 and t(4) = 3.16, p = .034; within people
// F(1, 2) = 100, t = 10, p = .010, d_z = 5.77.
TEST(StudyReport, ComparesConditionsAsPublishedAndWithinPeople) {
  StudySummary s;
  s.headline = {"threshold", "ms", 1e3, "ms", 1e3};
  for (const auto& [name, figures] :
       {std::pair("a", std::array{1e-3, 2e-3, 3e-3}), std::pair("b", std::array{4e-3, 5e-3, 7e-3})}) {
    StudyCondition c;
    c.name = name;
    for (std::size_t i = 0; i < figures.size(); ++i) c.people.push_back({static_cast<std::int64_t>(i), figures[i]});
    c.headline = estimateMean({figures.begin(), figures.end()});
    s.conditions.push_back(c);
  }
  const std::string html = studyTestsHtml(s);
  EXPECT_TRUE(contains(html, "F(1, 4) = 10.00, p = 0.034")) << html;
  EXPECT_TRUE(contains(html, "F(1, 2) = 100.00, p = 0.010")) << html;
  EXPECT_TRUE(contains(html, "t(4) = 3.16, p 0.034")) << html;
  EXPECT_TRUE(contains(html, "<td>3.33</td>") && contains(html, "<td>5.77</td>")) << html;
  s.conditions.pop_back();
  EXPECT_EQ(studyTestsHtml(s), "") << "one condition can't differ";
}

TEST(StudyReport, SaysWhereStaircasesNeverSettled) {
  const TemporaryDirectory dir;
  writeDelaySession(dir / "a.db", true);
  const SessionReader session(dir / "a.db");
  const std::string table = formatStudyTable(summariseStudy(session, session.responses()));
  EXPECT_TRUE(contains(table, "≥ 70.0")) << table;
}

TEST(StudyReport, EveryFigureStandsInThePageAndBesideItWithItsNumbers) {
  const TemporaryDirectory dir;
  writeDelaySession(dir / "a.db", false);
  const ReportFiles files = writeStudyReport(SessionReader(dir / "a.db"), dir / "report.html");
  const std::string html = readFile(files.html);
  for (const char* name : {"headline", "staircases", "psychometric", "speeds", "times"}) {
    EXPECT_TRUE(contains(html, std::string("figure-") + name)) << name;
    EXPECT_GT(std::filesystem::file_size(files.figures_directory + "/" + name + ".png"), 1000u) << name;
    EXPECT_GT(std::filesystem::file_size(files.figures_directory + "/" + name + ".csv"), 20u) << name;
  }
  EXPECT_TRUE(contains(html, "0123456789abcdef"));
}

// Of studies with one finger no report said either.
TEST(StudyReport, SaysHowFarTheDisplayWasFromWhatItWasToldAndHowLongTicksTook) {
  const TemporaryDirectory dir;
  writeDelaySession(dir / "a.db", false);
  Database(dir / "a.db", Database::Mode::kWrite).run("UPDATE session SET state = 'running'");
  {
    SessionWriter writer = SessionWriter::resume(dir / "a.db");
    for (int k = 0; k < 100; ++k) {
      SampleRecord sample;
      sample.tick = 50 * k;
      sample.time = 0.05 * k;
      sample.tick_us = 2;
      sample.fingers[0].flags = 1;
      sample.fingers[0].place_wanted_L = {1e-3, 0};
      sample.fingers[0].place_shown_L = {1.25e-3, 0};
      writer.pushSample(sample);
    }
    ResponseRecord last;
    last.trial = 40;
    last.condition = "whole";
    writer.finishResponse(last);
    writer.close();
  }
  const ReportFiles files = writeStudyReport(SessionReader(dir / "a.db"), dir / "report.html");
  const std::string html = readFile(files.html);
  EXPECT_TRUE(contains(html, "figure-tick_times"));
  EXPECT_TRUE(contains(readFile(files.figures_directory + "/tick_times_percentiles.csv"), "\n0.5,2\n"));
  EXPECT_TRUE(contains(html, "Errors of the displays, and what people notice"));
  EXPECT_TRUE(contains(html, "<td>0.25</td>")) << "the median";
}

}  // namespace
}  // namespace pincer::tasks
