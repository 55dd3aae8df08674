// csv: one table as text, after RFC 4180 with "\n" line ends.
//
// Numbers are written with the fewest digits that read back to the same bits; NaN is `nan`. Text with a comma,
// quote or line end is quoted. Text that a spreadsheet would take for a formula is kept from it
// (spreadsheetText); numbers stay numbers.
#pragma once
#include <fmt/format.h>

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace pincer::tasks {

// `text` as a cell that a spreadsheet shows and doesn't run: one that begins with = + - @ a tab or a carriage
// return, and is no number, gets an apostrophe before it, and so does one that begins with an apostrophe. Who takes
// off one leading apostrophe has the text back.
std::string spreadsheetText(std::string_view text);

// `text` without what ends a field or a line of gnuplot's tables, which know no quoted quotes:
// " becomes ', a control character a blank.
std::string plotText(std::string_view text);

class CsvTable {
 public:
  enum class Reader { kAnyone, kGnuplot };

  CsvTable() = default;
  explicit CsvTable(Reader reader) : reader_(reader) {}
  explicit CsvTable(std::initializer_list<std::string_view> columns, Reader reader = Reader::kAnyone)
      : reader_(reader) {
    for (const std::string_view c : columns) add(c);
    endRow();
  }

  void add(std::string_view text) {
    separate();
    addQuoted(spreadsheetText(reader_ == Reader::kGnuplot ? plotText(text) : std::string(text)));
  }
  template <class Number>
  requires std::integral<Number> || std::floating_point<Number>
  void add(Number value) {
    separate();
    if constexpr (std::floating_point<Number>) {
      if (value != value) return text_.append("nan"), void();  // fmt would tell -nan from nan
    }
    fmt::format_to(std::back_inserter(text_), "{}", value);
  }
  void endRow() {
    text_ += '\n';
    first_ = true;
  }
  template <class... Fields>
  void row(const Fields&... fields) {
    (add(fields), ...);
    endRow();
  }

  const std::string& text() const { return text_; }
  // The text since the last take(), for streaming.
  std::string take() {
    std::string taken;
    taken.swap(text_);
    return taken;
  }

 private:
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }
  void addQuoted(std::string_view text);
  std::string text_;
  Reader reader_ = Reader::kAnyone;
  bool first_ = true;
};

// A table beside a figure, whose columns gnuplot counts.
class PlotTable : public CsvTable {
 public:
  PlotTable() : CsvTable(Reader::kGnuplot) {}
  PlotTable(std::initializer_list<std::string_view> columns) : CsvTable(columns, Reader::kGnuplot) {}
};

}  // namespace pincer::tasks
