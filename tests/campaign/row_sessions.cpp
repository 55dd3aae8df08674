// Sessions that something went through: columns of other types and ranges, bytes flipped, files cut off. Then all that reads sessions.
#include <fmt/format.h>

#include "tests/campaign/inputs.h"
#include "tests/campaign/mutation.h"
#include "tests/campaign/rows.h"
#include "tests/campaign/session_file.h"

namespace pincer::campaign {
namespace {

// SQL expressions. What is read is then of another type, out of range, too long, or hostile.
const std::vector<std::string>& wrongValues() {
  static const std::vector<std::string> kValues = {
      "NULL",  "-1",    "0",    "1e300",  "-1e300", "9223372036854775807", "-9223372036854775807 - 1", "9007199254740993", "1e999",
      "''",    "'x'",   "'-1'", "'{}'",   "'[]'",   "'{\"a\": [1, 2'",     "x'00ff00ff'",              "zeroblob(100000)", "'18446744073709551616'",
      "' 1 '", "'1e3'", "'0x1f'", "'complete'", "'a' || char(27) || '[31m' || char(10) || 'b'", "hex(randomblob(50000))",
      "'force'", "'cld+force'", "'$(touch pwned)'", "'<script>alert(1)</script>'", "'=1+1'", "2147483648", "0.5", "7"};
  return kValues;
}

struct Damage {
  bool of_study;
  Column column;
  std::size_t value;
};

const std::vector<Damage>& damages(const Ground& ground) {
  static const std::vector<Damage> kDamages = [&] {
    std::vector<Damage> all;
    for (const bool of_study : {false, true}) {
      for (const Column& column : columnsOf(of_study ? studySession(ground) : pickupSession(ground))) {
        // A sample has fifty columns of numbers that go the same way: some of them.
        if (column.table == "sample" && column.name.find("_y_") != std::string::npos) continue;
        for (std::size_t v = 0; v < wrongValues().size(); ++v) all.push_back({of_study, column, v});
      }
    }
    return all;
  }();
  return kDamages;
}

std::string taskOf(bool of_study) { return of_study ? "repeated-localisation" : "sphere-pickup"; }

// What reads sessions, drawn by what it costs.
void readSession(Case& c, const std::string& task) {
  const std::vector<std::vector<std::string>> readers = {{"export", "session.db", "--out", "csv"},
                                                         {"export", "session.db", "--bids", "bids"},
                                                         {"replay", "session.db", "--trial", "1"},
                                                         {"run", task, "--resume", "--out", ".", "--no-report"},
                                                         {"report", "session.db", "--json"}};
  const std::size_t which = c.chance(0.12) ? 4 : static_cast<std::size_t>(c.below(4));
  Launch launch = c.pincer(readers[which]);
  launch.limit = 20;
  c.run(launch, {.name = "session.db"});
}

}  // namespace

int allDamagedColumns(const Ground& ground) { return static_cast<int>(damages(ground).size()); }

void damageColumn(Case& c) {
  const Damage& d = damages(c.ground)[scattered(c.ground, c.number, damages(c.ground).size())];
  const bool killed = !d.of_study && c.chance(0.3);
  const fs::path from = d.of_study ? studySession(c.ground) : killed ? killedSession(c.ground) : pickupSession(c.ground);
  for (const char* suffix : {"", "-wal"}) {
    if (fs::exists(from.string() + suffix)) fs::copy_file(from.string() + suffix, c.folder / ("session.db" + std::string(suffix)));
  }
  damage(c.folder / "session.db", d.column, wrongValues()[d.value], c.chance(0.5));
  readSession(c, taskOf(d.of_study));
  if (fs::exists(c.folder / "pwned")) c.fault(Verdict::kWrong, "a command of the session was obeyed");
}

void damageSessionFile(Case& c) {
  const bool of_study = c.chance(0.3);
  std::string bytes = readFile(of_study ? studySession(c.ground) : pickupSession(c.ground));
  for (int n = 1 + c.below(4); n > 0; --n) bytes = mutatedBytes(c.random, bytes);
  if (c.chance(0.5)) bytes.replace(0, 16, "SQLite format 3", 16);
  c.write("session.db", bytes);
  if (c.chance(0.3) && fs::exists(killedSession(c.ground).string() + "-wal")) {
    c.write("session.db-wal", mutatedBytes(c.random, readFile(killedSession(c.ground).string() + "-wal")));
  }
  readSession(c, taskOf(of_study));
}

}  // namespace pincer::campaign
