// Damaged sessions: whatever stands in the file, reporting, exporting, replaying and resuming it
// succeed or say what is wrong (InputError).
//
// Every column of every table is damaged in turn, tables and columns are taken away, bytes are turned, the protocol's
// numbers are changed. PINCER_DAMAGE=N repeats it N times with other random numbers (default 1).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <regex>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/report/report.h"
#include "pincer/tasks/lab/report/study_report.h"
#include "pincer/tasks/lab/sessions/manipulation_session.h"
#include "pincer/tasks/lab/sessions/replay.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/session/bids_export.h"
#include "pincer/tasks/run/session/csv_export.h"
#include "pincer/tasks/run/session/database.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::contains;
using tests::readFile;
using tests::TemporaryDirectory;

const std::atomic<bool> kUndisturbed{false}, kStopped{true};

int rounds() {
  const char* asked = std::getenv("PINCER_DAMAGE");
  return asked ? std::max(1, std::atoi(asked)) : 1;
}

constexpr int kDrawEvery = 8;  // cases; a page takes a dozen processes

// The arithmetic of a replay is another test's; here its reading counts.
ServoReport doNothing(HandsCycle&, const TrialRecord&) { return {}; }

class Damage {
 public:
  Damage() {
    std::ofstream(gnuplot()) << "#!/bin/sh\nfor ending in png svg; do echo x > \"${2%.gp}.$ending\"; done\n";
    std::filesystem::permissions(gnuplot(), std::filesystem::perms::owner_all);
    makePickups();
    makeHands();
    makeStudy();
  }
  std::string pickups() const { return dir_ / "pickups.db"; }
  std::string hands() const { return dir_ / "hands.db"; }
  std::string study() const { return dir_ / "study.db"; }
  std::string copy() const { return dir_ / "damaged.db"; }

  // A copy, damaged by `damage`, read in every way. `what` was done, for whoever reads that it failed.
  void tryAll(const std::string& original, const std::string& what,
              const std::function<void(const std::string&)>& damage) {
    for (const char* suffix : {"", "-wal", "-shm", "-journal", "-lock"}) std::filesystem::remove(copy() + suffix);
    std::filesystem::copy_file(original, copy());
    damage(copy());
    ++cases;
    SCOPED_TRACE(std::filesystem::path(original).filename().string() + ": " + what);
    attempt("report", [&] { report(); });
    attempt("export", [&] { exportCsv(SessionReader(copy()), dir_ / "csv", {}); });
    attempt("export --bids", [&] { exportBids(SessionReader(copy()), dir_ / "bids"); });
    attempt("replay",
            [&] { replaySession(SessionReader(copy()), {.other_version = true}, kUndisturbed, {}, doNothing); });
    attempt("run --resume", [&] { resume(); });
  }

  int cases = 0, refused = 0;

 private:
  std::string gnuplot() const { return dir_ / "gnuplot"; }

  void attempt(const char* command, const std::function<void()>& act) {
    try {
      act();
    } catch (const InputError& error) {
      ++refused;
      EXPECT_GT(std::string(error.what()).size(), 20u) << command;
    } catch (const std::exception& error) {
      ADD_FAILURE() << command << ": " << error.what();
    }
  }
  void report() {
    const SessionReader session(copy());
    const bool draws = cases % kDrawEvery == 0;
    if (isStudy(session.info().task)) {
      formatStudyTable(summariseStudy(session, session.responses()));
      if (draws) writeStudyReport(session, dir_ / "r.html", {gnuplot()});
    } else {
      summaryJson(summariseSession(session));
      if (draws) writeReport(session, dir_ / "r.html", {gnuplot()});
    }
  }
  void resume() {
    ManipulationSessionOptions options;
    resumeManipulationSession(options, copy(), kStopped, {});
  }

  // Two quick trials of a simulated participant.
  void makePickups() {
    ManipulationSessionOptions options;
    options.study.participants = 1;
    options.study.tasks = {HandTask::kPickup};
    options.study.training.pickups = 0;
    options.study.conditions = {publishedHandConditions()[1]};
    options.study.pickup.frictions = {0.9};
    options.study.pickup.repetitions = 2;
    options.study.pickup.timeout = 1;
    options.sample_rate = 20;
    runManipulationSession(options, pickups(), kUndisturbed, {});
    Database(pickups(), Database::Mode::kWrite).run("UPDATE session SET state = 'running'");
  }
  // The same, said to be a person's: with inputs that nobody gave.
  void makeHands() {
    SessionInfo info = SessionReader(pickups()).info();
    info.devices_json = R"({"arms": "usb"})";
    SessionWriter writer = SessionWriter::create(hands(), info);
    for (const TrialRecord& trial : SessionReader(pickups()).trials()) {
      HandsRecord hands;
      hands.trial = trial.trial;
      writer.addHands(hands);
      for (std::int64_t k = 0; k < 40; ++k) {
        InputRecord input;
        input.trial = trial.trial;
        input.tick = k;
        input.time = 1e-3 * static_cast<double>(k);
        writer.pushInput(input);
      }
      writer.finishTrial(trial);
    }
    writer.abort("interrupted");
  }
  void makeStudy() {
    SessionInfo info;
    info.task = "delay-discrimination";
    info.protocol_json = studyJson(delayStudy());
    SessionWriter writer = SessionWriter::create(study(), info);
    for (std::int64_t k = 0; k < 12; ++k) {
      ResponseRecord r;
      r.trial = k;
      r.index = k;
      r.condition = "whole";
      r.level = k % 2 ? 0.08 : 0.04;
      r.correct = k % 3 != 0;
      r.reversal = k % 2;
      r.outcome = "answered";
      r.answer = "1";
      writer.finishResponse(r);
    }
    writer.abort("interrupted");
  }

  TemporaryDirectory dir_;
};

std::vector<std::string> namesBy(const std::string& path, const std::string& sql) {
  const Database database(path, Database::Mode::kRead);
  std::vector<std::string> names;
  Statement rows(database, sql);
  while (rows.step()) names.push_back(rows.text(0));
  return names;
}

std::vector<std::string> tablesOf(const std::string& path) {
  return namesBy(path, "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name");
}

// Values that a column may be changed to, as SQL.
constexpr const char* kValues[] = {"NULL",
                                   "-1",
                                   "9223372036854775807",
                                   "(-9223372036854775807 - 1)",
                                   "1e300",
                                   "-1e300",
                                   "9e999",
                                   "-9e999",
                                   "0.5",
                                   "1e-320",
                                   "''",
                                   "'text'",
                                   "'12abc'",
                                   "'-1'",
                                   "'99999999999999999999'",
                                   "x'00ff'",
                                   "x''",
                                   "char(0)",
                                   "'a' || char(0) || '''\"`$(id)<&%'",
                                   "zeroblob(100000)"};

TEST(DamagedSession, AnyValueOfAnyColumnIsReadOrRefused) {
  Damage damage;
  std::size_t turn = 0;
  for (int round = 0; round < rounds(); ++round) {
    for (const std::string& original : {damage.pickups(), damage.hands(), damage.study()}) {
      for (const std::string& table : tablesOf(original)) {
        for (const std::string& column : namesBy(original, "SELECT name FROM pragma_table_info('" + table + "')")) {
          const std::string value = kValues[turn++ % std::size(kValues)];
          const std::string sql = "UPDATE " + table + " SET \"" + column + "\" = " + value +
                                  " WHERE rowid = (SELECT min(rowid) FROM " + table + ")";
          damage.tryAll(original, sql,
                        [&](const std::string& path) { Database(path, Database::Mode::kWrite).run(sql); });
        }
      }
    }
  }
  EXPECT_GT(damage.cases, 400);
  EXPECT_GT(damage.refused, 100);
}

TEST(DamagedSession, MissingTablesAndColumnsAndDoubledRowsAreNamed) {
  Damage damage;
  std::mt19937 random(3);
  for (const std::string& original : {damage.pickups(), damage.hands(), damage.study()}) {
    for (const std::string& table : tablesOf(original)) {
      for (const std::string& sql :
           {"DROP TABLE " + table, "DELETE FROM " + table, "ALTER TABLE " + table + " RENAME TO other",
            "CREATE TABLE twin AS SELECT * FROM " + table + "; DROP TABLE " + table + "; CREATE TABLE " + table +
                " AS SELECT * FROM twin UNION ALL SELECT * FROM twin"}) {
        damage.tryAll(original, sql, [&](const std::string& path) { Database(path, Database::Mode::kWrite).run(sql); });
      }
      const auto columns =
          namesBy(original, "SELECT name FROM pragma_table_info('" + table + "') WHERE name <> 'trial'");
      const std::string sql = "ALTER TABLE " + table + " DROP COLUMN \"" + columns[random() % columns.size()] + "\"";
      damage.tryAll(original, sql, [&](const std::string& path) { Database(path, Database::Mode::kWrite).run(sql); });
    }
  }
  EXPECT_GT(damage.refused, 100);
}

TEST(DamagedSession, AnyTurnedByteAndAnyLengthIsReadOrRefused) {
  Damage damage;
  std::mt19937 random(1);
  for (int k = 0; k < 60 * rounds(); ++k) {
    const std::string original = k % 3 == 0 ? damage.pickups() : k % 3 == 1 ? damage.hands() : damage.study();
    damage.tryAll(original, "random bytes, case " + std::to_string(k), [&](const std::string& path) {
      std::string bytes = readFile(path);
      if (k % 4 == 0) bytes.resize(random() % bytes.size());
      for (std::size_t n = random() % 20; n > 0 && !bytes.empty(); --n)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (k % 4 == 1)
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(random() % (bytes.size() / 2)), bytes.size() / 8, '\0');
      std::ofstream(path, std::ios::binary) << bytes;
    });
  }
  EXPECT_GT(damage.refused, 30);
}

TEST(DamagedSession, AnyNumberOfTheProtocolIsReadOrRefused) {
  Damage damage;
  std::mt19937 random(2);
  const std::regex number("[-0-9.e+]*[0-9]");
  for (int k = 0; k < 30 * rounds(); ++k) {
    const std::string original = k % 2 ? damage.pickups() : damage.study();
    std::string protocol = SessionReader(original).info().protocol_json;
    std::vector<std::smatch> found;
    for (auto at = std::sregex_iterator(protocol.begin(), protocol.end(), number); at != std::sregex_iterator(); ++at)
      found.push_back(*at);
    const std::smatch& which = found[random() % found.size()];
    const char* values[] = {"0", "-1", "1e300", "0.5", "1e-300", "\"x\"", "[]", "null", "18446744073709551616"};
    protocol.replace(static_cast<std::size_t>(which.position()), static_cast<std::size_t>(which.length()),
                     values[random() % std::size(values)]);
    damage.tryAll(original,
                  protocol.substr(static_cast<std::size_t>(which.position()) -
                                      std::min<std::size_t>(40, static_cast<std::size_t>(which.position())),
                                  60),
                  [&](const std::string& path) {
                    Database database(path, Database::Mode::kWrite);
                    Statement update(database, "UPDATE session SET protocol_json = ?");
                    update.bind(0, std::string_view(protocol));
                    update.step();
                  });
  }
  EXPECT_EQ(damage.cases, 30 * rounds());
}

// An error tells file, table, row, column, value, range and remedy.
TEST(DamagedSession, NamesTheCellThatIsWrong) {
  Damage damage;
  const auto errorAfter = [&](const std::string& original, const std::string& sql) {
    std::filesystem::remove(damage.copy());
    std::filesystem::copy_file(original, damage.copy());
    Database(damage.copy(), Database::Mode::kWrite).run(sql);
    return tests::errorOf([&] { exportCsv(SessionReader(damage.copy()), damage.copy() + ".csv", {}); });
  };
  EXPECT_TRUE(contains(errorAfter(damage.pickups(), "UPDATE session SET seed = 'seven'"),
                       "damaged.db: table session, row 1: seed = \"seven\" isn't a whole number in [0, "
                       "18446744073709551615], as text. The file is"));
  EXPECT_TRUE(contains(errorAfter(damage.pickups(), "UPDATE trial SET mu_s = -0.3 WHERE trial = 1"),
                       "table trial, row 2: mu_s = -0.3 isn't a number in [0, 1000000]. "));
  EXPECT_TRUE(contains(errorAfter(damage.pickups(), "UPDATE trial SET training = 'no' WHERE trial = 0"),
                       "table trial, row 1: training = \"no\" isn't a whole number in [0, 1]."));
  EXPECT_TRUE(contains(errorAfter(damage.pickups(), "ALTER TABLE trial DROP COLUMN drops"), "no such column: drops"));
}

TEST(DamagedSession, ATrialOutsideThePlanIsNamed) {
  Damage damage;
  Database(damage.pickups(), Database::Mode::kWrite).run("UPDATE trial SET trial = 999 WHERE trial = 1");
  const std::string error = tests::errorOf(
      [&] { replaySession(SessionReader(damage.pickups()), {.trial = 999}, kUndisturbed, {}, doNothing); });
  EXPECT_TRUE(contains(error, "trial 1000 isn't one of its plan, which has trials 1 to 2")) << error;
  const std::string resumed = tests::errorOf([&] { resumeManipulationSession({}, damage.pickups(), kStopped, {}); });
  EXPECT_TRUE(contains(resumed, "trial 1000 isn't one of its plan")) << resumed;
}

}  // namespace
}  // namespace pincer::tasks
