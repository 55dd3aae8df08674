// column_meanings: what each column of a session's tables means, its unit and its levels, for people: in exported
// tables, in BIDS and in docs/reference, from one place.
//
// People count from 1: trials, participants, runs and places in an order do so wherever they are exported
// or shown. In session.db they begin at 0.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pincer/tasks/run/session/columns.h"
#include "pincer/tasks/run/session/session_conditions.h"

namespace pincer::tasks {

struct ColumnMeaning {
  std::string description;  // a sentence's part: "force between the finger and what it touches, along the normal"
  std::string unit;         // "N", "m/s"; empty: it has none
  std::vector<std::pair<std::string, std::string>> levels;  // of a column of few values: each and what it means
};

// `conditions` are the levels of a column that names one. Throws std::logic_error for a column that nobody described.
ColumnMeaning meaningOf(std::string_view table, const ColumnName& column, const ConditionLabels& conditions = {});

// 1 for a column that counts what people count, else 0: what an exported value is larger by.
int countsFrom(const ColumnName& column);

// The levels on one line: "0: no; 1: yes".
std::string levelText(const ColumnMeaning& meaning);

struct DescribedColumn {
  std::string table, column;
  ColumnMeaning meaning;
};
// Of every exported table, in order.
std::vector<DescribedColumn> allColumns(const ConditionLabels& conditions = {});

// All columns as a table: table, column, unit, description, levels.
std::string columnsCsv(const ConditionLabels& conditions = {});
std::string columnsMarkdown();

}  // namespace pincer::tasks
