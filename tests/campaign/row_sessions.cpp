// Sessions that something went through: columns of other types and ranges, bytes flipped,
// files cut off. Then all that reads sessions.
#include <fmt/format.h>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/mutation.h"
#include "pincer/tests/campaign/rows.h"
#include "pincer/tests/campaign/session_file.h"

namespace pincer::campaign {
namespace {

// SQL expressions. What is read is then of another type, out of range, too long, or hostile.
const std::vector<std::string>& wrongValues() {
  static const std::vector<std::string> kValues = {"NULL",
                                                   "-1",
                                                   "0",
                                                   "1e300",
                                                   "-1e300",
                                                   "9223372036854775807",
                                                   "-9223372036854775807 - 1",
                                                   "9007199254740993",
                                                   "1e999",
                                                   "''",
                                                   "'x'",
                                                   "'-1'",
                                                   "'{}'",
                                                   "'[]'",
                                                   "'{\"a\": [1, 2'",
                                                   "x'00ff00ff'",
                                                   "zeroblob(100000)",
                                                   "'18446744073709551616'",
                                                   "' 1 '",
                                                   "'1e3'",
                                                   "'0x1f'",
                                                   "'complete'",
                                                   "'a' || char(27) || '[31m' || char(10) || 'b'",
                                                   "hex(randomblob(50000))",
                                                   "'force'",
                                                   "'cld+force'",
                                                   "'$(touch pwned)'",
                                                   "'<script>alert(1)</script>'",
                                                   "'=1+1'",
                                                   "2147483648",
                                                   "0.5",
                                                   "7"};
  return kValues;
}

struct Kind {
  const char* task;
  fs::path (*session)(const Ground&);
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kKinds = {
      {"sphere-pickup", pickupSession}, {"sphere-pickup", peoplesSession}, {"repeated-localisation", studySession}};
  return kKinds;
}

struct Damage {
  Kind kind;
  Column column;
  std::size_t value;
};

// A sample, and what is known of hands, has dozens of columns of numbers that are read by the same code: some of them.
bool isOneOfMany(const Column& column) {
  const bool many = column.table == "sample" || column.table == "hands";
  return many && (column.name.starts_with("f1_") || column.name.find("_y") != std::string::npos ||
                  column.name.find("_z") != std::string::npos);
}

const std::vector<Damage>& damages(const Ground& ground) {
  static const std::vector<Damage> kDamages = [&] {
    std::vector<Damage> all;
    for (const Kind& kind : kinds()) {
      for (const Column& column : columnsOf(kind.session(ground))) {
        for (std::size_t v = 0; v < wrongValues().size() && !isOneOfMany(column); ++v) all.push_back({kind, column, v});
      }
    }
    return all;
  }();
  return kDamages;
}

// Runs the commands that read sessions. The tables are quick; of what takes longer one is drawn.
void readSession(Case& c, const std::string& task, const std::set<int>& export_codes = {0, 3}) {
  std::vector<std::vector<std::string>> readers = {{"export", "session.db", "--out", "csv"},
                                                   {"export", "session.db", "--bids", "bids"}};
  if (c.chance(0.15)) {
    readers.push_back({"report", "session.db", "--json"});
  } else if (c.chance(0.5)) {
    readers.push_back({"replay", "session.db"});
  } else {
    readers.push_back({"run", task, "--resume", "--out", ".", "--no-report"});
  }
  for (const auto& arguments : readers) {
    Launch launch = c.pincer(arguments);
    launch.limit = 20;
    Expect expect{.name = "session.db"};
    // the tables: every column is read
    if (arguments[0] == "export" && arguments[2] == "--out") expect.codes = export_codes;
    c.run(launch, expect);
  }
}

}  // namespace

int allDamagedColumns(const Ground& ground) { return static_cast<int>(damages(ground).size()); }

void damageColumn(Case& c) {
  const Damage& d = damages(c.ground)[scattered(c.ground, c.number, damages(c.ground).size())];
  const bool killed = d.kind.session == pickupSession && c.chance(0.3);
  const fs::path from = killed ? killedSession(c.ground) : d.kind.session(c.ground);
  for (const char* suffix : {"", "-wal"}) {
    if (fs::exists(from.string() + suffix))
      fs::copy_file(from.string() + suffix, c.folder / ("session.db" + std::string(suffix)));
  }
  const std::string type = damage(c.folder / "session.db", d.column, wrongValues()[d.value], c.chance(0.5));
  const bool is_number = d.column.type == "INTEGER" || d.column.type == "REAL";
  // Text where a number belongs isn't taken for zero.
  readSession(c, d.kind.task, is_number && (type == "text" || type == "blob") ? std::set{3} : std::set{0, 3});
  if (fs::exists(c.folder / "pwned")) c.fault(Verdict::kWrong, "a command of the session was obeyed");
}

void damageSessionFile(Case& c) {
  const Kind& kind = c.anyOf(kinds());
  std::string bytes = readFile(kind.session(c.ground));
  for (int n = 1 + c.below(4); n > 0; --n) bytes = mutatedBytes(c.random, bytes);
  if (c.chance(0.5)) bytes.replace(0, 16, "SQLite format 3", 16);
  c.write("session.db", bytes);
  if (c.chance(0.3))
    c.write("session.db-wal", mutatedBytes(c.random, readFile(killedSession(c.ground).string() + "-wal")));
  readSession(c, kind.task);
}

}  // namespace pincer::campaign
