#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/process/interrupted.h"
#include "pincer/tasks/run/session/database.h"

namespace pincer::tasks {

namespace {

constexpr int kBusyTimeout = 3000;  // [ms] for a reader that holds the file, such as a backup program

struct Remedy {
  int code;  // primary result code
  const char* text;
};

// By SQLite's primary result code; others have no remedy.
constexpr Remedy kRemedies[] = {
    {SQLITE_FULL, "The disk (or quota) is full. Free some space or choose another disk."},
    {SQLITE_IOERR, "The disk or network share reports an error. Check it, or choose a local disk."},
    {SQLITE_READONLY,
     "The file or its directory can't be written. Check permissions, or work on a copy (the file with its -wal)."},
    {SQLITE_CANTOPEN, "Check that the directory exists and that you may read and write it."},
    {SQLITE_BUSY, "Another program holds the file. Close it and try again."},
    {SQLITE_LOCKED, "Another program holds the file. Close it and try again."},
    {SQLITE_CORRUPT, "The file is damaged; `sqlite3 FILE .recover` may save rows."},
    {SQLITE_NOMEM, "There is too little memory. Close other programs and try again."},
    {SQLITE_TOOBIG, "A value in the file is longer than any that pincer writes: the file is damaged, or no session."},
    {SQLITE_CONSTRAINT,
     "A trial of that number is there already, so something else wrote this session. Go on with a copy of before."},
    {SQLITE_ERROR,
     "The file lacks a table or column, so it was changed by something else or is damaged. Take a copy of before."},
    {SQLITE_NOTADB,
     "The file is no SQLite database, so no session. Give the path of a session that `pincer run` wrote."},
};

// SQLite's own allocator, and where that has nothing left, a reserve for the last words (LastWords). The reserve is
// given out from its beginning and never taken back: marking a session as aborted takes some tens of kilobytes, once.
class Reserve {
 public:
  static void install() {
    sqlite3_config(SQLITE_CONFIG_GETMALLOC, &usual_);
    sqlite3_mem_methods methods = usual_;
    methods.xMalloc = allocate;
    methods.xFree = release;
    methods.xRealloc = resize;
    methods.xSize = sizeOf;
    sqlite3_config(SQLITE_CONFIG_MALLOC, &methods);
  }
  static inline thread_local bool open_ = false;

 private:
  struct Header {
    alignas(std::max_align_t) int size;
  };
  static void* allocate(int size) {
    void* block = usual_.xMalloc(size);
    return block || !open_ ? block : fromReserve(size);
  }
  static void* fromReserve(int size) {
    const std::size_t rounded =
        (static_cast<std::size_t>(size) + alignof(Header) - 1) / alignof(Header) * alignof(Header);
    const std::size_t at = used_.fetch_add(sizeof(Header) + rounded);
    if (at + sizeof(Header) + rounded > bytes_.size()) return nullptr;
    auto* header = new (bytes_.data() + at) Header{size};
    return header + 1;
  }
  static bool isOurs(const void* block) {
    const auto* byte = static_cast<const std::byte*>(block);
    return byte >= bytes_.data() && byte < bytes_.data() + bytes_.size();
  }
  static void release(void* block) {
    if (!isOurs(block)) usual_.xFree(block);
  }
  static int sizeOf(void* block) {
    return isOurs(block) ? (static_cast<const Header*>(block) - 1)->size : usual_.xSize(block);
  }
  static void* resize(void* block, int size) {
    if (!isOurs(block)) {
      void* grown = usual_.xRealloc(block, size);
      if (grown || !open_) return grown;
    }
    void* moved = allocate(size);
    if (!moved) return nullptr;
    std::memcpy(moved, block, static_cast<std::size_t>(std::min(size, sizeOf(block))));
    release(block);
    return moved;
  }

  static inline sqlite3_mem_methods usual_{};
  alignas(Header) static inline std::array<std::byte, 4 << 20> bytes_{};
  static inline std::atomic<std::size_t> used_{0};
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

// A program that was killed between the two halves of a change leaves a journal, which undoes the first half. Only who
// may write can do so; of anything else that is wrong the reader tells.
void undoTornWrite(sqlite3* reader, const std::string& path) {
  constexpr const char* kRead = "PRAGMA user_version";  // the least that reads the file
  if (sqlite3_exec(reader, kRead, nullptr, nullptr, nullptr) != SQLITE_READONLY_ROLLBACK) return;
  sqlite3* writer = nullptr;
  if (sqlite3_open_v2(path.c_str(), &writer, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK) {
    sqlite3_busy_timeout(writer, kBusyTimeout);
    distrust(writer);
    sqlite3_exec(writer, kRead, nullptr, nullptr, nullptr);
  }
  sqlite3_close_v2(writer);
}

}  // namespace

void Database::Close::operator()(sqlite3* d) const noexcept { sqlite3_close_v2(d); }
void Statement::Finalize::operator()(sqlite3_stmt* s) const noexcept { sqlite3_finalize(s); }

LastWords::LastWords() noexcept { Reserve::open_ = true; }
LastWords::~LastWords() { Reserve::open_ = false; }

void Database::fail(int code, std::string_view doing) const {
  if ((code & 0xff) == SQLITE_NOMEM || code == SQLITE_IOERR_NOMEM) throw std::bad_alloc();
  std::string cause = sqlite3_errstr(code);
  if (handle() && (sqlite3_errcode(handle()) & 0xff) == (code & 0xff)) cause = printable(sqlite3_errmsg(handle()));
  const int system = handle() ? sqlite3_system_errno(handle()) : 0;
  const bool from_system = (code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN;
  if (system != 0 && from_system) cause += fmt::format(" ({})", std::strerror(system));
  throw InputError(fmt::format("{}: {} failed: {}. {}", path_, doing, cause, remedyFor(code)));
}

Database::Database(std::string path, Mode mode) : path_(std::move(path)) {
  static const bool once = (Reserve::install(), true);  // before SQLite's first word
  static_cast<void>(once);
  sqlite3* raw = nullptr;
  // without SQLite's lock around each call, a hundred per sample: a Database belongs to one thread at a time
  const int flags = SQLITE_OPEN_NOMUTEX | (mode == Mode::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE);
  const int code = sqlite3_open_v2(path_.c_str(), &raw, flags, nullptr);
  database_.reset(raw);
  if (code != SQLITE_OK) fail(code, "opening the session");
  sqlite3_extended_result_codes(raw, 1);
  sqlite3_busy_timeout(raw, kBusyTimeout);
  distrust(raw);
  if (mode == Mode::kRead) undoTornWrite(raw, path_);
}

void Database::run(const char* sql) {
  const int code = sqlite3_exec(handle(), sql, nullptr, nullptr, nullptr);
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
  const int code = sqlite3_prepare_v3(database.handle(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &raw, nullptr);
  statement_.reset(raw);
  if (code != SQLITE_OK) database.fail(code, "reading the session");
}

// A value that isn't bound would be stored as NULL.
void Statement::must(int code) const {
  if (code != SQLITE_OK) database_->fail(code, "writing the session");
}

void Statement::bind(int parameter, double value) { must(sqlite3_bind_double(statement_.get(), parameter + 1, value)); }
void Statement::bind(int parameter, std::int64_t value) {
  must(sqlite3_bind_int64(statement_.get(), parameter + 1, value));
}
void Statement::bind(int parameter, std::string_view value) {
  must(sqlite3_bind_text64(statement_.get(), parameter + 1, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
}

void Statement::bindBytes(int parameter, std::string_view value) {
  must(sqlite3_bind_blob64(statement_.get(), parameter + 1, value.data(), value.size(), SQLITE_TRANSIENT));
}

bool Statement::step() {
  if (database_->isInterrupted()) throw Interrupted();
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  sqlite3_reset(statement_.get());
  if (code != SQLITE_DONE)
    database_->fail(code, sqlite3_stmt_readonly(statement_.get()) ? "reading the session" : "writing the session");
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

std::optional<double> Statement::number(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_NULL:
      return std::numeric_limits<double>::quiet_NaN();
    case SQLITE_INTEGER:
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement_.get(), column);
    default:
      return std::nullopt;
  }
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string Statement::text(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (!bytes && sqlite3_errcode(database_->handle()) == SQLITE_NOMEM) throw std::bad_alloc();  // else NULL, or empty
  return bytes ? std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(size)) : std::string();
}

}  // namespace pincer::tasks
