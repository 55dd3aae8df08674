#include "pincer/tasks/run/files/json_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pincer::tasks {

namespace {

// Bytes of the UTF-8 character that `text` begins with; 0: none does. Table 3-7 of the Unicode standard.
std::size_t lengthOfCharacter(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0), second = byte(1);
  const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    const bool possible = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second <= 0x9f);
    return possible && follows(1) && follows(2) ? 3 : 0;
  }
  if (first < 0xf0 || first > 0xf4) return 0;
  const bool possible = (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second <= 0x8f);
  return possible && follows(1) && follows(2) && follows(3) ? 4 : 0;
}

std::string numberText(double number) { return std::isfinite(number) ? fmt::format("{}", number) : "null"; }

}  // namespace

std::string quotedJson(std::string_view text) {
  constexpr std::string_view kNoCharacter = "\uFFFD";  // Unicode's, for bytes that aren't UTF-8
  std::string out = "\"";
  while (!text.empty()) {
    const char c = text.front();
    const std::size_t length = lengthOfCharacter(text);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += length > 0 ? text.substr(0, length) : kNoCharacter;
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return out + '"';
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  text_ += quotedJson(name) + ": ";
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  text_ += quotedJson(text);
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  separate();
  text_ += numberText(number);
  return *this;
}

JsonWriter& JsonWriter::value(std::int64_t number) {
  separate();
  text_ += fmt::format("{}", number);
  return *this;
}

JsonWriter& JsonWriter::value(std::uint64_t number) {
  separate();
  text_ += fmt::format("{}", number);
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  separate();
  text_ += truth ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::row(std::span<const double> numbers) {
  separate();
  text_ += '[';
  for (std::size_t i = 0; i < numbers.size(); ++i) text_ += (i > 0 ? ", " : "") + numberText(numbers[i]);
  text_ += ']';
  return *this;
}

JsonWriter& JsonWriter::value(const Vec3& v) { return row(std::array{v.x(), v.y(), v.z()}); }

JsonWriter& JsonWriter::value(const Quat& q) { return row(std::array{q.w(), q.x(), q.y(), q.z()}); }

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  empty_.push_back(true);
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  const bool was_empty = empty_.back();
  empty_.pop_back();
  if (!was_empty) breakLine();
  text_ += bracket;
  if (empty_.empty()) text_ += '\n';
  return *this;
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (empty_.empty()) return;
  if (!empty_.back()) text_ += ',';
  empty_.back() = false;
  breakLine();
}

void JsonWriter::breakLine() {
  text_ += '\n';
  text_.append(2 * empty_.size(), ' ');
}

}  // namespace pincer::tasks
