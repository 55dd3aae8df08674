#include "pincer/tasks/run/csv.h"

#include <charconv>

namespace pincer::tasks {
namespace {

bool isNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size();
}

}  // namespace

std::string spreadsheetText(std::string_view text) {
  // Characters that begin a formula in spreadsheets, and the mark before a text that keeps it one.
  constexpr std::string_view kBeginFormulas = "=+-@\t\r", kKept = "'";
  const bool guarded =
      !text.empty() && (text.starts_with(kKept) || (kBeginFormulas.find(text[0]) != text.npos && !isNumber(text)));
  return fmt::format("{}{}", guarded ? kKept : "", text);
}

std::string plotText(std::string_view text) {
  std::string plain(text);
  for (char& c : plain) {
    if (c == '"') c = '\'';
    if ((c >= 0 && c < ' ') || c == 0x7f) c = ' ';
  }
  return plain;
}

void CsvTable::addQuoted(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    text_ += text;
    return;
  }
  text_ += '"';
  for (const char c : text) text_.append(c == '"' ? 2 : 1, c);
  text_ += '"';
}

}  // namespace pincer::tasks
