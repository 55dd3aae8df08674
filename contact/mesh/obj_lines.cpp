#include "contact/mesh/obj_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "contact/error.h"

namespace pincer::contact {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view withoutPlus(std::string_view word) {  // from_chars refuses the sign that the format allows
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

std::string inQuotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text(word.substr(0, kLongest));
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return "\"" + text + (word.size() > kLongest ? "...\"" : "\"");
}

ObjLines::ObjLines(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool ObjLines::next() {
  words_.clear();
  bool continued = false;
  while (!rest_.empty()) {
    lines_joined_ = continued ? lines_joined_ + 1 : 0;
    ++line_;
    const std::size_t end = rest_.find('\n');
    last_line_is_open_ = end == std::string_view::npos;
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(last_line_is_open_ ? rest_.size() : end + 1);
    line = line.substr(0, line.find('#'));
    if (line.ends_with('\r')) line.remove_suffix(1);
    continued = line.ends_with('\\');
    if (continued) line.remove_suffix(1);
    splitLine(line);
    if (!continued && !words_.empty()) return true;
  }
  return !words_.empty();
}

void ObjLines::splitLine(std::string_view line) {
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words_.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
}

void ObjLines::failAt(int line, const std::string& message) const { throw InputError(fmt::format("{}:{}: {}", name_, line, message)); }

void ObjLines::fail(const std::string& message) const {
  const char* hint =
      last_line_is_open_ ? " The file ends in the middle of this line, so it was probably cut off: export or copy it again." : "";
  failAt(line_ - lines_joined_, message + hint);
}

double ObjLines::number(std::string_view word, std::string_view what) const {
  const std::string_view digits = withoutPlus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(fmt::format("{} = {} is beyond the range of double precision. Export the mesh again.", what, inQuotes(word)));
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(fmt::format("{} = {} is not a number. Numbers are written like -0.25 or 3e-2, with a point.", what, inQuotes(word)));
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("{} = {} must be finite. Export the mesh again; its program had no valid value here.", what, inQuotes(word)));
  }
  return value;
}

std::int32_t ObjLines::integer(std::string_view word, std::string_view what) const {
  const std::string_view digits = withoutPlus(word);
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) fail(fmt::format("{} {} is out of range; no file has that many.", what, inQuotes(word)));
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(fmt::format("{} {} is not a whole number. A corner of a face is written v, v/vt, v//vn or v/vt/vn.", what, inQuotes(word)));
  }
  return value;
}

}  // namespace pincer::contact
