#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "contact/error.h"
#include "tasks/session/database.h"

namespace pincer::tasks {

namespace {

constexpr int kBusyTimeout = 3000;  // [ms] for a reader that holds the file, such as a backup program

struct Remedy {
  int code;  // primary result code
  const char* text;
};

constexpr Remedy kRemedies[] = {
    {SQLITE_FULL, "The disk (or quota) is full. Free some space or choose another disk."},
    {SQLITE_IOERR, "The disk or network share reports an error. Check it, or choose a local disk."},
    {SQLITE_READONLY, "The file or its directory can't be written. Check permissions, or work on a copy (the file with its -wal)."},
    {SQLITE_CANTOPEN, "Check that the directory exists and that you may read and write it."},
    {SQLITE_BUSY, "Another program holds the file. Close it and try again."},
    {SQLITE_LOCKED, "Another program holds the file. Close it and try again."},
    {SQLITE_CORRUPT, "The file is damaged; `sqlite3 FILE .recover` may save rows."},
    {SQLITE_NOMEM, "There is too little memory. Close other programs and try again."},
    {SQLITE_TOOBIG, "A value in the file is longer than any that pincer writes: the file is damaged, or no session."},
    {SQLITE_CONSTRAINT, "A trial of that number is there already, so something else wrote this session. Go on with a copy of before."},
    {SQLITE_ERROR, "The file lacks a table or column, so it was changed by something else or is damaged. Take a copy of before."},
    {SQLITE_NOTADB, "The file is no SQLite database, so no session. Give the path of a session that `pincer run` wrote."},
};

const char* remedyFor(int code) {
  for (const Remedy& r : kRemedies) {
    if (r.code == (code & 0xff)) return r.text;
  }
  return "Run `sqlite3 FILE 'PRAGMA integrity_check'` on the file.";
}

// For a file that may be anybody's: https://www.sqlite.org/security.html.
void distrust(sqlite3* d) {
  sqlite3_db_config(d, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(d, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(d, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(d, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(d, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);  // a column that is missing isn't read as its own name
  sqlite3_db_config(d, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_limit(d, SQLITE_LIMIT_LENGTH, Database::kLongestValue);
  sqlite3_exec(d, "PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0", nullptr, nullptr, nullptr);
}

}  // namespace

void Database::Close::operator()(sqlite3* d) const noexcept { sqlite3_close_v2(d); }
void Statement::Finalize::operator()(sqlite3_stmt* s) const noexcept { sqlite3_finalize(s); }

void Database::fail(int code, std::string_view doing) const {
  std::string cause = sqlite3_errstr(code);
  if (handle() && (sqlite3_errcode(handle()) & 0xff) == (code & 0xff)) cause = sqlite3_errmsg(handle());
  const int system = handle() ? sqlite3_system_errno(handle()) : 0;
  const bool from_system = (code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN;
  if (system != 0 && from_system) cause += fmt::format(" ({})", std::strerror(system));
  throw InputError(fmt::format("{}: {} failed: {}. {}", path_, doing, cause, remedyFor(code)));
}

Database::Database(std::string path, Mode mode) : path_(std::move(path)) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path_.c_str(), &raw, mode == Mode::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE, nullptr);
  database_.reset(raw);
  if (code != SQLITE_OK) fail(code, "opening the session");
  sqlite3_extended_result_codes(raw, 1);
  sqlite3_busy_timeout(raw, kBusyTimeout);
  distrust(raw);
}

void Database::run(const std::string& sql) {
  const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code, "writing the session");
}

std::int64_t Database::integer(const std::string& sql) const {
  Statement s(*this, sql);
  return s.step() ? s.integer(0) : 0;
}

std::string Database::text(const std::string& sql) const {
  Statement s(*this, sql);
  return s.step() ? s.text(0) : "";
}

void Database::rollBack() noexcept {
  if (handle() && !sqlite3_get_autocommit(handle())) sqlite3_exec(handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Database::close() {
  const int code = sqlite3_close(handle());
  if (code != SQLITE_OK) fail(code, "closing the session");
  database_.release();
}

Statement::Statement(const Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v3(database.handle(), sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
  statement_.reset(raw);
  if (code != SQLITE_OK) database.fail(code, "reading the session");
}

void Statement::bind(int parameter, double value) { sqlite3_bind_double(statement_.get(), parameter + 1, value); }
void Statement::bind(int parameter, std::int64_t value) { sqlite3_bind_int64(statement_.get(), parameter + 1, value); }
void Statement::bind(int parameter, std::string_view value) {
  sqlite3_bind_text64(statement_.get(), parameter + 1, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

void Statement::bindBytes(int parameter, std::string_view value) {
  sqlite3_bind_blob64(statement_.get(), parameter + 1, value.data(), value.size(), SQLITE_TRANSIENT);
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  sqlite3_reset(statement_.get());
  if (code != SQLITE_DONE) database_->fail(code, sqlite3_stmt_readonly(statement_.get()) ? "reading the session" : "writing the session");
  return false;
}

CellType Statement::type(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_INTEGER:
      return CellType::kInteger;
    case SQLITE_FLOAT:
      return CellType::kReal;
    case SQLITE_TEXT:
      return CellType::kText;
    case SQLITE_BLOB:
      return CellType::kBytes;
    default:
      return CellType::kNull;
  }
}

double Statement::real(int column) const {
  if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  return sqlite3_column_double(statement_.get(), column);
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return bytes ? std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size)) : std::string();
}

}  // namespace pincer::tasks
