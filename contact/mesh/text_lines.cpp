#include "pincer/contact/mesh/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pincer/contact/io/printable.h"

namespace pincer::contact {

namespace {

// a polygon of 1000 corners with three long indices each takes half of it
constexpr std::size_t kLongestLine = std::size_t{1} << 16;

bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view withoutPlus(std::string_view word) {  // from_chars refuses the sign that the formats allow
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

bool isAscii(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](unsigned char c) { return c > 0 && c < 0x80; });
}

}  // namespace

TextLines::TextLines(MeshFile& file, LineRules rules) : file_(file), rules_(rules) {
  const std::string_view text = file.bytes();
  if (text.starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    file.fail("the file is UTF-16 text; mesh files are ASCII. Save it again as ASCII or UTF-8.");
  }
}

bool TextLines::next() {
  words_.clear();
  lines_joined_ = 0;
  std::size_t joined = 0;
  while (position_ < file_.bytes().size()) {
    std::string_view line = takeLine();
    joined += line.size();
    if (line.find('\0') != std::string_view::npos)
      fail("the line holds a NUL byte, which is no part of a text. The file is damaged; export it again.");
    if (joined > kLongestLine)
      fail(fmt::format("the line is longer than {} bytes. Is this a text file? Export it again.", kLongestLine));
    if (rules_.comments) line = line.substr(0, line.find('#'));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool continued = rules_.continued && line.ends_with('\\');
    if (continued) line.remove_suffix(1);
    splitLine(line);
    if (!continued && !words_.empty()) return true;
    lines_joined_ = continued ? lines_joined_ + 1 : 0;
    if (!continued) joined = 0;
  }
  return !words_.empty();
}

std::string_view TextLines::takeLine() {
  ++line_;
  const std::string_view rest = file_.bytes().substr(position_);
  const std::size_t end = rest.find('\n');
  last_line_is_open_ = end == std::string_view::npos;
  const std::string_view line = rest.substr(0, end);
  position_ += line.size() + (last_line_is_open_ ? 0 : 1);
  file_.reached(position_);
  return line;
}

void TextLines::splitLine(std::string_view line) {
  for (std::size_t begin = 0, end = 0;; begin = end) {
    while (begin < line.size() && isBlank(line[begin])) ++begin;
    if (begin == line.size()) return;
    for (end = begin; end < line.size() && !isBlank(line[end]);) ++end;
    words_.push_back(line.substr(begin, end - begin));
  }
}

void TextLines::fail(const std::string& message) const {
  const char* hint =
      last_line_is_open_
          ? " The file ends in the middle of this line, so it was probably cut off: export or copy it again."
          : "";
  file_.failAt(line_ - lines_joined_, message + hint);
}

void TextLines::failAsNumber(std::string_view word, std::string_view what, bool out_of_range) const {
  if (out_of_range)
    fail(fmt::format("{} = {} is beyond the range of numbers here. Export the mesh again.", printable(what),
                     inQuotes(word)));
  if (!isAscii(word)) {
    fail(fmt::format(
        "{} = {} holds bytes that aren't ASCII text. The file is damaged or isn't a text file; export it again.",
        printable(what), inQuotes(word)));
  }
  fail(fmt::format("{} = {} is not a number. Numbers are written like -0.25 or 3e-2, with a point.", printable(what),
                   inQuotes(word)));
}

double TextLines::number(std::string_view word, std::string_view what) const {
  const std::string_view digits = withoutPlus(word);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    failAsNumber(word, what, error == std::errc::result_out_of_range);
  if (!std::isfinite(value)) {
    fail(fmt::format("{} = {} must be finite. Export the mesh again; its program had no valid value here.",
                     printable(what), inQuotes(word)));
  }
  return value;
}

std::int64_t TextLines::integer(std::string_view word, std::string_view what) const {
  const std::string_view digits = withoutPlus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)
    fail(fmt::format("{} {} is out of range; no file has that many.", printable(what), inQuotes(word)));
  if (error != std::errc() || end != digits.data() + digits.size()) {
    fail(fmt::format("{} {} is not a whole number. Export the mesh again.", printable(what), inQuotes(word)));
  }
  return value;
}

}  // namespace pincer::contact
