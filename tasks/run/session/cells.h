// cells: a value of a session's file, checked as it is read: its type, then its column's range
// (columns.h). Internal to the session store.
//
//   a.db: table trial, row 3: mu_s = -0.3 isn't a number in [0, 1000000]. The file is damaged, or ...
//
// Every value that comes out of a session passes here, so that what reads sessions needs no check of its own.
#pragma once
#include <charconv>

#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session/database.h"

namespace pincer::tasks {

// One value, and where it stands.
struct Cell {
  const Statement& row;
  int column;  // in the statement
  std::string_view table;
  std::int64_t row_number;  // SQLite's rowid
  const ColumnName& name;

  // Throws InputError: "<file>: table <table>, row <row>: <column> = <value> isn't <wanted>. <remedy>".
  [[noreturn]] void refuse(const std::string& wanted) const;
};

std::string wordsOf(const ColumnRange& range, std::string_view kind);  // "a number in [0, 1], or nothing"

inline void readCell(const Cell& cell, std::string& field) {
  if (cell.row.type(cell.column) != CellType::kText) cell.refuse("text");
  field = cell.row.text(cell.column);
}

inline void readCell(const Cell& cell, Bytes& field) {
  if (cell.row.type(cell.column) != CellType::kBytes) cell.refuse("bytes");
  field.value = cell.row.text(cell.column);
}

// As text: SQLite's integers are signed.
inline void readCell(const Cell& cell, std::uint64_t& field) {
  const std::string text = cell.row.type(cell.column) == CellType::kText ? cell.row.text(cell.column) : "";
  const auto read = std::from_chars(text.data(), text.data() + text.size(), field);
  if (read.ec == std::errc{} && read.ptr == text.data() + text.size() && !text.empty()) return;
  cell.refuse("a whole number in [0, 18446744073709551615], as text");
}

inline void readCell(const Cell& cell, double& field) {
  const std::optional<double> number = cell.row.number(cell.column);
  const ColumnRange range = cell.name.rangeOf<double>();
  if (!number || !range.holds(*number)) cell.refuse(wordsOf(range, "number"));
  field = *number;
}

template <class Integer>
requires std::is_integral_v<Integer>
void readCell(const Cell& cell, Integer& field) {
  const ColumnRange range = cell.name.rangeOf<Integer>();
  const std::int64_t value = cell.row.integer(cell.column);
  if (cell.row.type(cell.column) != CellType::kInteger || !range.holds(static_cast<double>(value))) {
    cell.refuse(wordsOf(range, "whole number"));
  }
  field = static_cast<Integer>(value);
}

}  // namespace pincer::tasks
