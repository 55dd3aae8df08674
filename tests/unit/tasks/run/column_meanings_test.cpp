// Meanings of the columns of a session's tables: said of each, once.
#include "pincer/tasks/run/session/column_meanings.h"

#include <gtest/gtest.h>

#include <set>

#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/csv_export.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

TEST(ColumnMeanings, EveryColumnIsDescribed) {
  std::set<std::string> tables;
  for (const DescribedColumn& c : allColumns()) {
    tables.insert(c.table);
    EXPECT_GE(c.meaning.description.size(), 7u) << c.table << "." << c.column;
    EXPECT_NE(c.meaning.description, c.column);
    for (const auto& [value, means] : c.meaning.levels)
      EXPECT_FALSE(value.empty() || means.empty()) << c.table << "." << c.column;
  }
  EXPECT_EQ(tables.size(), 9u);
}

TEST(ColumnMeanings, AColumnThatNobodyDescribedIsNoticed) {
  EXPECT_THROW(meaningOf("trial", ColumnName{"", "colour", "", ""}), std::logic_error);
}

TEST(ColumnMeanings, SayWhichFingerAxisAndUnit) {
  const ColumnMeaning meaning = meaningOf("sample", ColumnName{"f1", "f_contact_W", "z", "N"});
  EXPECT_EQ(meaning.description, "of the thumb: sum of the contact forces on it, in the world; z");
  EXPECT_EQ(meaningOf("response", ColumnName{"", "finger_speed", "", "m_per_s"}).unit, "m/s");
}

// People count from 1: in rows as in the names of files.
TEST(ColumnMeanings, ExportsCountFromOne) {
  const tests::TemporaryDirectory dir;
  SessionInfo info;
  info.task = "sphere-pickup";
  info.protocol_json =
      R"({"conditions": [{"name": "force", "label": "bare"}, {"name": "heavy", "label": ""}, "cld+force"]})";
  SessionWriter writer = SessionWriter::create(dir / "s.db", info);
  TrialRecord trial;
  trial.condition = "force";
  trial.outcome = "success";
  writer.finishTrial(trial);
  writer.close();
  const SessionReader reader(dir / "s.db");
  exportCsv(reader, dir / "csv");
  EXPECT_TRUE(tests::contains(tests::readFile(dir / "csv/trial.csv"), "\n1,sphere-pickup,1,force,0,1,"));
  EXPECT_TRUE(tests::contains(tests::readFile(dir / "csv/columns.csv"), "trial,grip_ratio,,"));
  EXPECT_TRUE(tests::contains(tests::readFile(dir / "csv/columns.csv"),
                              "trial,condition,,\"condition of the study, as its file names it\",force: bare; heavy: "
                              "heavy; cld+force: CLD + force\n"));
  exportBids(reader, dir / "bids");
  EXPECT_TRUE(
      tests::contains(tests::readFile(dir / "bids/participants.json"),
                      "\"Levels\": {\"force\": \"bare\", \"heavy\": \"heavy\", \"cld+force\": \"CLD + force\"}"));
  const std::string stem = dir / "bids/sub-01/beh/sub-01_task-spherepickup_beh";
  EXPECT_TRUE(tests::contains(tests::readFile(stem + ".tsv"), "\n1\tsphere-pickup\tsub-01\tforce\t0\t1\t"));
  const std::string sidecar = tests::readFile(stem + ".json");
  EXPECT_TRUE(
      tests::contains(sidecar, "\"grip_ratio\": {\"Description\": \"grip while held over the smallest that holds"));
  EXPECT_TRUE(tests::contains(
      sidecar,
      "\"training\": {\"Description\": \"before the counted trials, left out of all results\", \"Levels\": "
      "{\"0\": \"no\", \"1\": \"yes\"}}"));
  EXPECT_TRUE(tests::contains(
      sidecar, "\"duration_s\": {\"Description\": \"from the start tone to the end\", \"Units\": \"s\"}"));
}

}  // namespace
}  // namespace pincer::tasks
