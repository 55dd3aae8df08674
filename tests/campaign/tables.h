// tables: CSV (RFC 4180) and TSV as a spreadsheet or BIDS reads them.
#pragma once
#include <string>
#include <vector>

namespace pincer::campaign {

// Rows of cells; quotes are those of RFC 4180 where the separator is a comma, and plain characters where it is a tab.
std::vector<std::vector<std::string>> cellsOf(const std::string& text, char separator);

// The fault: rows of different lengths, a cell that a spreadsheet would take for a formula. Empty if nothing is.
std::string problemOfTable(const std::string& text, char separator);

}  // namespace pincer::campaign
