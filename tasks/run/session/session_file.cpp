#include "pincer/tasks/run/session/session_file.h"

#include "pincer/contact/error.h"
#include "pincer/contact/io/part_file.h"
#include "pincer/tasks/run/session/build_info.h"
#include "pincer/tasks/run/session/session_lock.h"
#include "pincer/tasks/run/session/table.h"

namespace pincer::tasks {
namespace {

template <class Record>
void makeTable(Database& d) {
  d.run(fmt::format("CREATE TABLE IF NOT EXISTS {} ({})", tableName<Record>(), columnList<Record>(true)));
}

// A trial's number is there once, whatever goes wrong; and what belongs to it is found without reading all.
void makeIndexes(Database& d) {
  for (const char* table : {"trial", "response", "hands"}) {
    d.run(fmt::format("CREATE UNIQUE INDEX IF NOT EXISTS one_row_per_trial_of_{0} ON {0} (trial)", table));
  }
  d.run("CREATE INDEX IF NOT EXISTS sample_of_trial ON sample (trial)");
  d.run("CREATE INDEX IF NOT EXISTS input_of_trial ON input (trial)");
}

// Adds the columns that aren't there: pincers before format 5 could be killed between one column and the next.
template <class Record>
void addColumnsSince(Database& d, std::int64_t format) {
  for (const auto& [name, type] : columnsSince<Record>(format)) {
    const std::string there =
        fmt::format("SELECT count(*) FROM pragma_table_info('{}') WHERE name = '{}'", tableName<Record>(), name);
    if (d.integer(there) == 0)
      d.run(fmt::format("ALTER TABLE {} ADD COLUMN \"{}\" {}", tableName<Record>(), name, type));
  }
}

void makeTables(Database& d, const SessionInfo& info) {
  d.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", kApplicationId, kFormat));
  d.run(fmt::format("CREATE TABLE session ({}, {})", columnList<SessionInfo>(true), columnList<SessionProgress>(true)));
  makeTable<TrialRecord>(d);
  makeTable<SampleRecord>(d);
  makeTable<EventRecord>(d);
  makeTable<ResponseRecord>(d);
  makeTable<ReadingRecord>(d);
  makeTable<HandsRecord>(d);
  makeTable<InputChunk>(d);
  makeTable<SurveyRecord>(d);
  makeIndexes(d);
  Statement insert(d, insertSql<SessionInfo>());
  insertRow(insert, info);
  d.run(
      fmt::format("UPDATE session SET started_utc = '{}', state = '{}', samples_dropped = 0", nowUtc(), kStateRunning));
}

}  // namespace

void openForWriting(Database& d, std::int64_t max_pages) {
  if (max_pages > 0) d.text(fmt::format("PRAGMA max_page_count = {}", max_pages));
  if (d.text("PRAGMA journal_mode = WAL") == "wal") return;
  throw InputError(d.path() +
                   ": this file system has no shared memory for SQLite's log. Keep sessions on a local disk.");
}

void makeSession(const std::string& path, const SessionInfo& info, std::int64_t max_pages) {
  PartFile part(path);
  part.release();
  Database d(part.name(), Database::Mode::kWrite);
  openForWriting(d, max_pages);
  d.run("PRAGMA synchronous = FULL; BEGIN");
  makeTables(d, info);
  d.run("COMMIT");
  d.close();
  part.placeNew();
}

void upgradeTables(Database& d) {
  const std::int64_t format = d.integer("PRAGMA user_version");
  addColumnsSince<SessionInfo>(d, format);
  d.run(
      "UPDATE session SET commit_id = '', sources = '', flags = '', c_library = '', processor = '' WHERE commit_id IS "
      "NULL");
  if (format >= 3) addColumnsSince<HandsRecord>(d, format);
  makeTable<HandsRecord>(d);
  makeTable<InputChunk>(d);
  makeTable<SurveyRecord>(d);
  makeIndexes(d);
  d.run(fmt::format("PRAGMA user_version = {}", kFormat));
}

void removeUnfinished(Database& d) {
  for (const char* table : {"sample", "event", "reading", "hands", "input"}) {
    d.run(fmt::format("DELETE FROM {} WHERE trial NOT IN (SELECT trial FROM trial UNION SELECT trial FROM response)",
                      table));
  }
}

void tellWhoGoesOn(Database& d, SessionInfo info) {
  addBuild(info);
  Statement update(
      d,
      "UPDATE session SET version = ?, build = ?, commit_id = ?, sources = ?, flags = ?, c_library = ?, processor = ?");
  int parameter = 0;
  for (const std::string* text :
       {&info.version, &info.build, &info.commit, &info.sources, &info.flags, &info.c_library, &info.processor}) {
    update.bind(parameter++, std::string_view(*text));
  }
  update.step();
}

}  // namespace pincer::tasks
