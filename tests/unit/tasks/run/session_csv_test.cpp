#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "pincer/contact/error.h"
#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/csv_export.h"
#include "pincer/tests/support/synthetic_session.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::readFile;

std::ptrdiff_t filesIn(const tests::TemporaryDirectory& dir) {
  return std::distance(std::filesystem::directory_iterator(dir.path()), {});
}
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

// One leading apostrophe keeps spreadsheets from running a text.
std::string unguarded(const std::string& cell) { return cell.starts_with('\'') ? cell.substr(1) : cell; }

RC_GTEST_PROP(CsvTable, KeepsAnyText, (const std::string& a, const std::string& b)) {
  CsvTable table;
  table.row(a, b);
  const auto rows = parse(table.text());
  RC_ASSERT(rows.size() == 1u && rows[0].size() == 2u);
  RC_ASSERT(unguarded(rows[0][0]) == a);
  RC_ASSERT(unguarded(rows[0][1]) == b);
}

constexpr const char* kHostile[] = {"=HYPERLINK(\"http://x\")",
                                    "+cmd|' /C calc'!A0",
                                    "-2+3",
                                    "@SUM(A1)",
                                    "\tx",
                                    "\rx",
                                    "'quoted",
                                    "a\tb\nc\\d\re",
                                    "\"\"",
                                    "''",
                                    "$(id)`id`%s{}_^@é"};

TEST(CsvTable, TextsThatLookLikeFormulasAreNotRunAndNumbersStayNumbers) {
  for (const char* text : {"=1+1", "+x", "-x", "@x", "\tx", "\rx", "'x", "-", "1e5x" /* harmless */}) {
    const std::string cell = spreadsheetText(text);
    EXPECT_EQ(unguarded(cell), text);
    EXPECT_EQ(std::string("=+-@\t\r").find(cell[0]), std::string::npos) << text;
  }
  for (const char* number : {"-0.5", "+3", "-1e-9", "0.0014", "-inf"}) EXPECT_EQ(spreadsheetText(number), number);
  CsvTable table;
  table.row("=1", -1.5, -3, "plain");
  EXPECT_EQ(table.text(), "'=1,-1.5,-3,plain\n");
}

TEST(PlotTable, HoldsNoQuoteThatGnuplotWouldMistake) {
  PlotTable table;
  table.row("a\",\"b", 1, "=x\ny");
  EXPECT_EQ(table.text(), "\"a','b\",1,'=x y\n");
}

// Another program's reader: Python's csv.
TEST(CsvTable, PythonReadsBackWhatWasWritten) {
  if (std::system("python3 -c 'import csv' > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no python3 here; KeepsAnyText reads it with our own parser";
  const TemporaryDirectory dir;
  CsvTable table;
  for (const char* text : kHostile) table.row(text, 0.1);
  writeAtomically(dir / "a.csv", table.text());
  std::ofstream(dir / "a.py")
      << "import csv,sys\nfor row in csv.reader(open(sys.argv[1], newline='', encoding='utf8'), strict=True):\n"
         "  sys.stdout.write(row[0].encode('utf8').hex() + ' ' + row[1] + '\\n')\n";
  const std::string command = "python3 '" + dir / "a.py" + "' '" + (dir / "a.csv") + "' > '" + (dir / "a.out") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::string expected;
  for (const char* text : kHostile) {
    for (const char c : spreadsheetText(text)) expected += fmt::format("{:02x}", static_cast<unsigned char>(c));
    expected += " 0.1\n";
  }
  EXPECT_EQ(readFile(dir / "a.out"), expected);
}

// Each row keeps its columns, whatever the names; each text comes back.
TEST(BidsExport, TabsLineEndsAndFormulasInNamesKeepTheirColumn) {
  const TemporaryDirectory dir;
  SessionInfo info = tests::SyntheticSession::info();
  info.task = "quo\"te \\ \n task";
  auto writer = SessionWriter::create(dir / "a.db", info);
  std::int64_t number = 0;
  for (const char* text : kHostile) {
    TrialRecord trial;
    trial.trial = number++;
    trial.condition = text;
    writer.finishTrial(trial);
  }
  writer.close();
  exportBids(SessionReader(dir / "a.db"), dir / "bids");
  EXPECT_NE(readFile(dir / "bids/dataset_description.json").find(R"("quo\"te \\ \u000a task, seed 1")"),
            std::string::npos)
      << readFile(dir / "bids/dataset_description.json");
  std::istringstream table(readFile(dir / "bids/sub-01/beh/sub-01_task-spherepickup_beh.tsv"));
  std::string head, line;
  std::getline(table, head);
  for (const char* text : kHostile) {
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_EQ(std::count(line.begin(), line.end(), '\t'), std::count(head.begin(), head.end(), '\t'));
    std::string field;
    std::istringstream fields(line);
    for (int k = 0; k < 4; ++k) std::getline(fields, field, '\t');  // trial, task, participant, condition
    std::string back;
    for (std::size_t i = 0; i < field.size(); ++i) {
      if (field[i] != '\\') {
        back += field[i];
        continue;
      }
      ++i;
      back += field[i] == 't' ? '\t' : field[i] == 'n' ? '\n' : field[i] == 'r' ? '\r' : field[i];
    }
    EXPECT_EQ(unguarded(back), text);
  }
  EXPECT_FALSE(std::getline(table, line));
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
  ASSERT_EQ(paths.size(), 7u);

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
  EXPECT_EQ(parse(readFile(dir / "new/csv/event.csv"))[1],
            (std::vector<std::string>{"1", "0.25", "slip", "thumb, \"fast\""}));
}

TEST(AtomicFile, LeavesTheOldFileUntilTheNewOneIsWhole) {
  const TemporaryDirectory dir;
  writeAtomically(dir / "a.txt", "old");
  {
    AtomicFile file(dir / "a.txt");
    file.write("half of the n");
  }
  EXPECT_EQ(readFile(dir / "a.txt"), "old");
  EXPECT_EQ(filesIn(dir), 1) << "a part is left";
  writeAtomically(dir / "a.txt", "new");
  EXPECT_EQ(readFile(dir / "a.txt"), "new");
}

TEST(AtomicFile, APlantedLinkIsNotFollowed) {
  const TemporaryDirectory dir;
  writeAtomically(dir / "victim", "precious");
  std::filesystem::create_symlink(dir / "victim", dir / "a.txt.part");
  std::filesystem::create_symlink(dir / "victim", dir / ".a.txt.0123456789abcdef.part");
  std::filesystem::create_symlink(dir / "victim", dir / "a.txt");
  writeAtomically(dir / "a.txt", "new");
  EXPECT_EQ(readFile(dir / "victim"), "precious");
  EXPECT_EQ(readFile(dir / "a.txt"), "new");
  EXPECT_FALSE(std::filesystem::is_symlink(dir / "a.txt"));
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotShareAPart) {
  const TemporaryDirectory dir;
  AtomicFile first(dir / "a.txt"), second(dir / "a.txt");
  first.write("first");
  second.write("second, longer");
  first.commit();
  EXPECT_EQ(readFile(dir / "a.txt"), "first");
  second.commit();
  EXPECT_EQ(readFile(dir / "a.txt"), "second, longer");
  EXPECT_EQ(filesIn(dir), 1);
}

TEST(AtomicFile, WhatAKilledProgramLeftIsRemoved) {
  const TemporaryDirectory dir;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(dir / "a.txt");
    if (::write(ends[1], "x", 1) == 1) ::pause();
  }
  char made = 0;
  ASSERT_EQ(::read(ends[0], &made, 1), 1);
  writeAtomically(dir / "a.txt", "mine");
  EXPECT_EQ(filesIn(dir), 2) << "the part of a program that lives was taken away";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  writeAtomically(dir / "other.txt", "");
  EXPECT_EQ(filesIn(dir), 3);
  writeAtomically(dir / "a.txt", "mine");
  EXPECT_EQ(filesIn(dir), 2) << "the part of a killed program is left";
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(AtomicFile, HasTheModeThatTheUmaskLeaves) {
  const TemporaryDirectory dir;
  const mode_t before = ::umask(027);
  writeAtomically(dir / "a.txt", "");
  ::umask(before);
  EXPECT_EQ(static_cast<unsigned>(std::filesystem::status(dir / "a.txt").permissions()), 0640u);
}

TEST(AtomicFile, TakesNamesAsLongAsTheSystemDoes) {
  const TemporaryDirectory dir;
  writeAtomically(dir / std::string(255, 'n'), "long");
  EXPECT_EQ(readFile(dir / std::string(255, 'n')), "long");
  EXPECT_THROW(writeAtomically(dir / std::string(256, 'n'), "longer"), InputError);
  EXPECT_EQ(filesIn(dir), 1);
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
