// session_file: a session's file seen without the program that wrote it: its rows compared, its columns damaged.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pincer::campaign {

namespace fs = std::filesystem;

struct Column {
  std::string table, name, type = {};  // as declared: TEXT, INTEGER, REAL, BLOB
};
// Of the tables that have rows.
std::vector<Column> columnsOf(const fs::path& session);

// Sets the column, in all rows or only in the one in the middle, to an SQL expression such as "NULL", "-1", "'text'",
// "x'00ff'". Returns the type of what stands there now: "null", "integer", "real", "text", "blob".
std::string damage(const fs::path& session, const Column& column, const std::string& expression, bool all_rows);

// How a session stands, read from a copy: looking changes nothing.
struct SessionState {
  bool readable = false;
  std::string state;  // "running", "complete", "aborted: ..."; empty before the session was made
  std::map<std::int64_t, std::string> trials;  // what was kept of each but how long ticks took; of responses likewise
  std::vector<std::int64_t> doubled;           // trials that stand there more than once
  std::string integrity;                       // "ok", or what SQLite finds wrong
};
SessionState stateOf(const fs::path& session);

// All that a session kept but times of the wall clock, versions and costs: the same for the same study.
std::string contentOf(const fs::path& session);

}  // namespace pincer::campaign
