#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <charconv>
#include <limits>
#include <sstream>

#include "contact/error.h"
#include "tasks/session/atomic_file.h"
#include "tasks/session/csv.h"
#include "tasks/session/csv_export.h"
#include "tests/support/synthetic_session.h"
#include "tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::readFile;
using tests::TemporaryDirectory;

std::vector<std::vector<std::string>> parse(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (quoted && c == '"' && i + 1 < csv.size() && csv[i + 1] == '"') {
      rows.back().back() += csv[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.emplace_back(1);
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();  // after the last line end
  return rows;
}

// Any bits of a finite number come back.
RC_GTEST_PROP(CsvTable, KeepsEveryBitOfANumber, (std::uint64_t bits)) {
  const double value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  CsvTable table;
  table.row(value);
  const std::string text = table.text();
  double back = 0;
  std::from_chars(text.data(), text.data() + text.size(), back);
  RC_ASSERT(std::bit_cast<std::uint64_t>(back) == bits);
}

RC_GTEST_PROP(CsvTable, KeepsAnyText, (const std::string& a, const std::string& b)) {
  CsvTable table;
  table.row(a, b);
  RC_ASSERT(parse(table.text()) == (std::vector<std::vector<std::string>>{{a, b}}));
}

TEST(CsvTable, WritesTheShortestNumberAndOneNan) {
  CsvTable table{"a", "b", "c", "d"};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  table.row(0.1, -nan, nan, 3);
  EXPECT_EQ(table.text(), "a,b,c,d\n0.1,nan,nan,3\n");
}

TEST(CsvExport, WritesEachTableWithUnitsInTheNames) {
  const TemporaryDirectory dir;
  auto writer = SessionWriter::create(dir / "a.db", tests::SyntheticSession::info(42));
  SampleRecord s;
  for (std::int64_t k = 0; k < 10; ++k) {
    s.tick = k;
    s.fingers[1].normal_force = 1.0 / 3;
    s.fingers[0].place_shown_L = {std::numeric_limits<double>::quiet_NaN(), 0};
    writer.pushSample(s);
  }
  writer.addEvent({0, 0.25, "slip", "thumb, \"fast\""});
  TrialRecord trial;
  trial.condition = "cld+force";
  trial.duration = 12.5;
  writer.finishTrial(trial);
  writer.close();
  const auto paths = exportCsv(SessionReader(dir / "a.db"), dir / "new/csv", {.stride = 3});
  ASSERT_EQ(paths.size(), 6u);

  const auto session = parse(readFile(dir / "new/csv/session.csv"));
  ASSERT_EQ(session.size(), 2u);
  EXPECT_EQ(session[0].size(), session[1].size());
  EXPECT_EQ(session[1][0], "sphere-pickup");
  EXPECT_EQ(session[1][1], "42");
  const auto samples = parse(readFile(dir / "new/csv/sample.csv"));
  ASSERT_EQ(samples.size(), 1u + 4u);  // ticks 0, 3, 6, 9
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(samples[0].begin(), samples[0].end(), name) - samples[0].begin());
  };
  EXPECT_EQ(samples[4].at(column("tick")), "9");
  EXPECT_EQ(samples[4].at(column("f1_normal_N")), "0.3333333333333333");
  EXPECT_EQ(samples[4].at(column("f0_place_shown_L_x_m")), "nan");
  const auto trials = parse(readFile(dir / "new/csv/trial.csv"));
  ASSERT_EQ(trials.size(), 2u);
  const auto duration = std::find(trials[0].begin(), trials[0].end(), "duration_s") - trials[0].begin();
  EXPECT_EQ(trials[1].at(static_cast<std::size_t>(duration)), "12.5");
  EXPECT_EQ(parse(readFile(dir / "new/csv/event.csv"))[1], (std::vector<std::string>{"0", "0.25", "slip", "thumb, \"fast\""}));
}

TEST(AtomicFile, LeavesTheOldFileUntilTheNewOneIsWhole) {
  const TemporaryDirectory dir;
  writeAtomically(dir / "a.txt", "old");
  {
    AtomicFile file(dir / "a.txt");
    file.write("half of the n");
  }
  EXPECT_EQ(readFile(dir / "a.txt"), "old");
  EXPECT_FALSE(std::filesystem::exists(dir / "a.txt.part"));
  writeAtomically(dir / "a.txt", "new");
  EXPECT_EQ(readFile(dir / "a.txt"), "new");
}

TEST(AtomicFile, NamesWhatItCanNotMake) {
  const TemporaryDirectory dir;
  EXPECT_THROW(writeAtomically(dir / "no/a.txt", ""), InputError);
  EXPECT_THROW(writeAtomically("/proc/a.txt", ""), InputError);
  EXPECT_THROW(writeAtomically("/dev/full/a", ""), InputError);
  writeAtomically(dir / "file", "");
  EXPECT_THROW(makeDirectory(dir / "file"), InputError);
  EXPECT_THROW(makeDirectory(dir / "file/below"), InputError);
}

}  // namespace
}  // namespace pincer::tasks
