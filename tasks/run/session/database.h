// database: an SQLite file behind a wall. The only file that speaks to SQLite is
// database_sqlite.cpp; this header knows none of its types.
//
// Every failure throws InputError that names the file, what was being done, SQLite's reason and what a person can do
// about it; where memory is short, std::bad_alloc.
// A Database and its Statements belong to one thread at a time.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace pincer::tasks {

class Database;

enum class CellType { kInteger, kReal, kText, kBytes, kNull };

// A prepared statement. Parameters and columns count from 0.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);
  Statement(Statement&&) noexcept = default;
  Statement& operator=(Statement&&) noexcept = default;

  // NaN is stored as NULL, and NULL is read as NaN.
  void bind(int parameter, double value);
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, std::string_view value);  // copied
  void bindBytes(int parameter, std::string_view value);

  bool step();  // true: a row is there; false: done, and ready to run again. Throws Interrupted (Database::heed)
  CellType type(int column) const;  // that is stored, before any conversion
  double real(int column) const;
  std::optional<double> number(int column) const;  // NaN for NULL; absent for texts and bytes
  std::int64_t integer(int column) const;
  std::string text(int column) const;  // or bytes
  const Database& database() const { return *database_; }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* s) const noexcept;
  };
  void must(int code) const;

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// While one lives, SQLite may use memory that was put aside at the start for this thread's statements, where there
// is no other: to mark a session as aborted.
class LastWords {
 public:
  LastWords() noexcept;
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;
};

// The file may be anybody's: views and triggers in it don't run, names in quotes are columns or errors and never texts,
// pages are checked as they are read, and no value is longer than kLongestValue.
class Database {
 public:
  static constexpr int kLongestValue = 100'000'000;  // [bytes]; a protocol has 20,000, a second of inputs 200,000
  enum class Mode { kRead, kWrite };
  Database(std::string path, Mode mode);  // the file must exist
  Database(Database&&) = delete;

  void run(const char* sql);  // one or several statements without parameters or wanted rows
  void run(const std::string& sql) { run(sql.c_str()); }
  std::int64_t integer(const std::string& sql) const;  // the first column of the first row; 0 if there is no row
  std::string text(const std::string& sql) const;
  void rollBack() noexcept;  // of a transaction that may have failed already
  void close();              // throws if SQLite can't
  // From now on statements end with Interrupted once the flag is up, which must outlive this. For readers.
  void heed(const std::atomic<bool>& interrupted) { interrupted_ = &interrupted; }

  const std::string& path() const { return path_; }
  sqlite3* handle() const { return database_.get(); }
  [[noreturn]] void fail(int code, std::string_view doing) const;
  bool isInterrupted() const { return interrupted_ != nullptr && interrupted_->load(std::memory_order_relaxed); }

 private:
  struct Close {
    void operator()(sqlite3* d) const noexcept;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
  const std::atomic<bool>* interrupted_ = nullptr;
};

}  // namespace pincer::tasks
