#include "pincer/tasks/run/session/cells.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kLongestShown = 40;  // characters of a text

std::string shown(const Cell& cell) {
  switch (cell.row.type(cell.column)) {
    case CellType::kNull:
      return "NULL";
    case CellType::kBytes:
      return fmt::format("{} bytes", cell.row.text(cell.column).size());
    case CellType::kInteger:
      return fmt::format("{}", cell.row.integer(cell.column));
    case CellType::kReal:
      return fmt::format("{}", cell.row.real(cell.column));
    case CellType::kText:
      break;
  }
  const std::string text = cell.row.text(cell.column);
  std::string words;
  for (const char c : text.substr(0, kLongestShown)) words += c >= ' ' && c <= '~' ? c : '?';
  return fmt::format("\"{}{}\"", words, text.size() > kLongestShown ? "..." : "");
}

}  // namespace

void Cell::refuse(const std::string& wanted) const {
  throw InputError(
      fmt::format("{}: table {}, row {}: {} = {} isn't {}. The file is damaged, or something else than pincer changed "
                  "it. Take a copy of "
                  "before; `sqlite3 FILE .recover` may save the other rows.",
                  row.database().path(), table, row_number, name.text(), shown(*this), wanted));
}

std::string wordsOf(const ColumnRange& range, std::string_view kind) {
  const std::string none = range.may_be_none ? ", or nothing" : "";
  if (range.min == -columns::kInfinity && range.max == columns::kInfinity) return fmt::format("a {}{}", kind, none);
  return fmt::format("a {} in [{:.17g}, {:.17g}]{}", kind, range.min, range.max, none);
}

}  // namespace pincer::tasks
