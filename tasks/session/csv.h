// csv: one table as text, after RFC 4180 with "\n" line ends.
//
// Numbers are written with the fewest digits that read back to the same bits; NaN is `nan`. Text with a comma, quote or line end is quoted.
#pragma once
#include <fmt/format.h>

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace pincer::tasks {

class CsvTable {
 public:
  CsvTable() = default;
  explicit CsvTable(std::initializer_list<std::string_view> columns) {
    for (const std::string_view c : columns) add(c);
    endRow();
  }

  void add(std::string_view text) {
    separate();
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
      text_ += text;
      return;
    }
    text_ += '"';
    for (const char c : text) text_.append(c == '"' ? 2 : 1, c);
    text_ += '"';
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
  // What has come since the last take(), for streaming.
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
  std::string text_;
  bool first_ = true;
};

}  // namespace pincer::tasks
