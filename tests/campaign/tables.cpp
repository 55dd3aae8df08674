#include "pincer/tests/campaign/tables.h"

#include <fmt/format.h>

#include <cstdlib>

namespace pincer::campaign {
namespace {

bool isNumber(const std::string& cell) {
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0';
}

bool isFormula(const std::string& cell) {
  return !cell.empty() && std::string("=+-@").find(cell[0]) != std::string::npos && !isNumber(cell) && cell != "-";
}

// The cell that begins at `at`; leaves `at` behind it.
std::string cellAt(const std::string& text, std::size_t& at, char separator) {
  std::string cell;
  const bool is_quoted = separator == ',' && at < text.size() && text[at] == '"';
  if (is_quoted) {
    for (++at; at < text.size(); ++at) {
      if (text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"')) break;
      at += text[at] == '"';
      cell += text[at];
    }
    ++at;
  }
  while (at < text.size() && text[at] != separator && text[at] != '\n') cell += text[at++];
  if (!is_quoted && cell.ends_with('\r')) cell.pop_back();
  return cell;
}

}  // namespace

std::vector<std::vector<std::string>> cellsOf(const std::string& text, char separator) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t at = 0; at < text.size(); ++at) {
    rows.emplace_back();
    for (;; ++at) {
      rows.back().push_back(cellAt(text, at, separator));
      if (at >= text.size() || text[at] == '\n') break;
    }
  }
  return rows;
}

std::string problemOfTable(const std::string& text, char separator) {
  const auto rows = cellsOf(text, separator);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != rows[0].size())
      return fmt::format("row {} has {} cells, the first one {}", i + 1, rows[i].size(), rows[0].size());
    for (const std::string& cell : rows[i]) {
      if (isFormula(cell)) return fmt::format("row {} holds the formula {}", i + 1, cell);
    }
  }
  return {};
}

}  // namespace pincer::campaign
