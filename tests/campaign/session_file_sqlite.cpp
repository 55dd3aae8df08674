#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>

#include "pincer/tests/campaign/session_file.h"

namespace pincer::campaign {
namespace {

class Store {
 public:
  Store(const fs::path& file, int mode) {
    if (sqlite3_open_v2(file.c_str(), &store_, mode, nullptr) != SQLITE_OK) {
      sqlite3_close(store_);
      throw std::runtime_error("can't open " + file.string());
    }
  }
  Store(Store&&) = delete;
  ~Store() { sqlite3_close(store_); }

  // Every row as the texts of its columns.
  void forEach(const std::string& sql, const std::function<void(const std::vector<std::string>&)>& take) {
    sqlite3_stmt* raw = nullptr;
    const bool ok = sqlite3_prepare_v2(store_, sql.c_str(), -1, &raw, nullptr) == SQLITE_OK;
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(raw, sqlite3_finalize);
    if (!ok) throw std::runtime_error(sqlite3_errmsg(store_));
    int step;
    while ((step = sqlite3_step(raw)) == SQLITE_ROW) {
      std::vector<std::string> row;
      for (int i = 0; i < sqlite3_column_count(raw); ++i) {
        const auto* bytes = static_cast<const char*>(sqlite3_column_blob(raw, i));
        row.emplace_back(bytes == nullptr ? "" : bytes,
                         bytes == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(raw, i)));
      }
      take(row);
    }
    if (step != SQLITE_DONE) throw std::runtime_error(sqlite3_errmsg(store_));
  }
  std::string first(const std::string& sql) {
    std::string value;
    forEach(sql, [&](const auto& row) { value = row.at(0); });
    return value;
  }

 private:
  sqlite3* store_ = nullptr;
};

std::vector<Column> columnsIn(Store& store) {
  std::vector<Column> columns;
  store.forEach(
      "SELECT m.name, c.name, c.type FROM sqlite_schema m, pragma_table_info(m.name) c WHERE m.type = 'table' ORDER BY "
      "1, c.cid",
      [&](const auto& row) {
        columns.push_back({row[0], row[1], row[2]});
      });
  return columns;
}

// True of columns that differ between two runs of the same study: clocks, versions, costs.
bool isOfTheRun(const Column& column) {
  static const std::vector<std::string> kOfTheRun = {"started_utc",     "tick_median_us", "tick_p999_us", "tick_us",
                                                     "samples_dropped", "build",          "version",      "processor"};
  return std::find(kOfTheRun.begin(), kOfTheRun.end(), column.name) != kOfTheRun.end();
}

std::string keptColumns(const std::vector<Column>& columns, const std::string& table) {
  std::string list;
  for (const Column& column : columns) {
    if (column.table == table && !isOfTheRun(column)) list += (list.empty() ? "\"" : ", \"") + column.name + "\"";
  }
  return list;
}

void addTrials(Store& store, const std::vector<Column>& columns, const std::string& table, SessionState& state) {
  store.forEach(fmt::format("SELECT {} FROM {} ORDER BY trial", keptColumns(columns, table), table),
                [&](const auto& row) {
                  const std::int64_t trial = std::stoll(row.at(0));
                  if (!state.trials.emplace(trial, fmt::format("{}", fmt::join(row, "|"))).second)
                    state.doubled.push_back(trial);
                });
}

// A copy with its log, so that looking doesn't fold the log in. Gone at the end.
class Copy {
 public:
  explicit Copy(const fs::path& session) : folder_(session.parent_path() / fmt::format("planted-copy-{}", ::getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    for (const char* suffix : {"", "-wal", "-journal"}) {
      if (fs::exists(session.string() + suffix)) fs::copy_file(session.string() + suffix, file().string() + suffix);
    }
  }
  Copy(Copy&&) = delete;
  ~Copy() { fs::remove_all(folder_); }
  fs::path file() const { return folder_ / "session.db"; }

 private:
  fs::path folder_;
};

}  // namespace

std::vector<Column> columnsOf(const fs::path& session) {
  const Copy copy(session);
  Store store(copy.file(), SQLITE_OPEN_READWRITE);
  std::vector<Column> columns = columnsIn(store);
  std::erase_if(columns,
                [&](const Column& column) { return store.first("SELECT count(*) FROM " + column.table) == "0"; });
  return columns;
}

std::string damage(const fs::path& session, const Column& column, const std::string& expression, bool all_rows) {
  Store store(session, SQLITE_OPEN_READWRITE);
  const std::string middle =
      fmt::format(" WHERE rowid = (SELECT rowid FROM {0} LIMIT 1 OFFSET (SELECT count(*) / 2 FROM {0}))", column.table);
  store.first(
      fmt::format("UPDATE {} SET \"{}\" = {}{}", column.table, column.name, expression, all_rows ? "" : middle));
  return store.first(fmt::format("SELECT typeof(\"{}\") FROM {}{}", column.name, column.table, middle));
}

SessionState stateOf(const fs::path& session) {
  SessionState state;
  if (!fs::exists(session)) return state;
  const Copy copy(session);
  try {
    Store store(copy.file(), SQLITE_OPEN_READWRITE);
    const std::vector<Column> columns = columnsIn(store);
    if (columns.empty()) return state;
    state.state = store.first("SELECT state FROM session");
    addTrials(store, columns, "trial", state);
    addTrials(store, columns, "response", state);
    state.integrity = store.first("PRAGMA integrity_check");
    state.readable = true;
  } catch (const std::exception& e) {
    state.integrity = e.what();
  }
  return state;
}

std::string contentOf(const fs::path& session) {
  const Copy copy(session);
  Store store(copy.file(), SQLITE_OPEN_READWRITE);
  const std::vector<Column> columns = columnsIn(store);
  std::string content, table;
  for (const Column& column : columns) {
    if (column.table == table) continue;
    table = column.table;
    store.forEach(fmt::format("SELECT {} FROM {} ORDER BY rowid", keptColumns(columns, table), table),
                  [&](const auto& row) { content += fmt::format("{}: {}\n", table, fmt::join(row, "|")); });
  }
  return content;
}

}  // namespace pincer::campaign
