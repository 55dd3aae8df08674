// table: rows of the session's tables, made from the column lists in columns.h. Internal to the session store.
//
//   table      record         one row per
//   session    SessionInfo    file; SessionProgress in the same row
//   trial      TrialRecord    finished trial
//   sample     SampleRecord   recorded tick
//   event      EventRecord    event
//   response   ResponseRecord finished trial of a psychophysical experiment
//   reading    ReadingRecord  deliberate reading of a simulated participant
//   hands      HandsRecord    trial of a person
//   input      InputChunk     some ticks of a trial of a person
//   survey     SurveyRecord   answer of a person to a question beside the trials
#pragma once
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pincer/tasks/run/session/cells.h"
#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session/database.h"

namespace pincer::tasks {

constexpr std::int64_t kApplicationId = 0x504e4352;  // "PNCR", in SQLite's header
constexpr std::int64_t kFormat = 6;                  // raised whenever a column changes or a table is added
constexpr std::int64_t kOldestFormat =
    2;  // that is still read: it lacks the tables hands, input and survey; ColumnName::since has the rest
constexpr std::int64_t kFirstLockedFormat = 5;  // whose writers hold a lock (session_lock.h)

// States of a session in its table; after "aborted: " stands the reason.
constexpr std::string_view kStateRunning = "running", kStateComplete = "complete", kStateAborted = "aborted: ";

template <class Record>
constexpr std::string_view tableName() {
  if constexpr (std::is_same_v<Record, SessionInfo> || std::is_same_v<Record, SessionProgress>) return "session";
  if constexpr (std::is_same_v<Record, TrialRecord>) return "trial";
  if constexpr (std::is_same_v<Record, SampleRecord>) return "sample";
  if constexpr (std::is_same_v<Record, EventRecord>) return "event";
  if constexpr (std::is_same_v<Record, ResponseRecord>) return "response";
  if constexpr (std::is_same_v<Record, ReadingRecord>) return "reading";
  if constexpr (std::is_same_v<Record, HandsRecord>) return "hands";
  if constexpr (std::is_same_v<Record, InputChunk>) return "input";
  if constexpr (std::is_same_v<Record, SurveyRecord>) return "survey";
}

template <class Field>
constexpr std::string_view sqlType() {
  if constexpr (std::is_floating_point_v<Field>) return "REAL";
  if constexpr (std::is_same_v<Field, Bytes>) return "BLOB";
  // SQLite's integers are signed
  if constexpr (std::is_same_v<Field, std::string> || std::is_same_v<Field, std::uint64_t>) return "TEXT";
  return "INTEGER";
}

// `"a", "b"` or, with types, `"a" REAL, "b" TEXT`.
template <class Record>
std::string columnList(bool with_types = false) {
  std::string list;
  const Record record{};
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field&) {
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name.text());
    if (with_types) list += fmt::format(" {}", sqlType<Field>());
  });
  return list;
}

struct AddedColumn {
  std::string name;
  std::string_view type;
};

// Columns that a file of format `format` lacks.
template <class Record>
std::vector<AddedColumn> columnsSince(std::int64_t format) {
  std::vector<AddedColumn> added;
  const Record record{};
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field&) {
    if (name.since > format) added.push_back({name.text(), sqlType<Field>()});
  });
  return added;
}

template <class Record>
std::string insertSql() {
  std::string marks;
  const Record record{};
  forEachColumn(record, [&](const ColumnName&, const auto&) { marks += marks.empty() ? "?" : ", ?"; });
  return fmt::format("INSERT INTO {} ({}) VALUES ({})", tableName<Record>(), columnList<Record>(), marks);
}

// The row's number, then the columns. Those that a file of format `format`
// lacks: nothing was measured, nothing was said.
template <class Record>
std::string selectSql(std::int64_t format) {
  std::string list = "rowid";
  const Record record{};
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field&) {
    const char* missing = std::is_floating_point_v<Field> ? "NULL" : std::is_same_v<Field, std::string> ? "''" : "0";
    list += name.since > format ? fmt::format(", {}", missing) : fmt::format(", \"{}\"", name.text());
  });
  return fmt::format("SELECT {} FROM {}", list, tableName<Record>());
}

template <class Record>
void insertRow(Statement& insert, const Record& record) {
  int parameter = 0;
  forEachColumn(record, [&]<class Field>(const ColumnName&, const Field& field) {
    if constexpr (std::is_same_v<Field, std::uint64_t>) {
      insert.bind(parameter++, std::string_view(std::to_string(field)));
    } else if constexpr (std::is_same_v<Field, Bytes>) {
      insert.bindBytes(parameter++, field.value);
    } else if constexpr (std::is_integral_v<Field>) {
      insert.bind(parameter++, static_cast<std::int64_t>(field));
    } else if constexpr (std::is_floating_point_v<Field>) {
      insert.bind(parameter++, field);
    } else {
      insert.bind(parameter++, std::string_view(field));
    }
  });
  insert.step();
}

// Of a statement by selectSql(). Throws InputError for a value that its column can't hold.
template <class Record>
Record readRow(const Statement& row) {
  Record record;
  int column = 1;
  forEachColumn(record, [&](const ColumnName& name, auto& field) {
    readCell({row, column++, tableName<Record>(), row.integer(0), name}, field);
  });
  return record;
}

}  // namespace pincer::tasks
