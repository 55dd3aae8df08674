#include "pincer/contact/io/printable.h"

#include <fmt/format.h>

#include <vector>

namespace pincer {
namespace {

// One character of UTF-8 at the front of a text.
struct Character {
  char32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;
};

// Source: The Unicode Standard, table 3-7 (well-formed UTF-8): no overlong
// forms, no surrogates, nothing beyond U+10FFFF.
Character firstOf(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return {first, 1, false};
  char32_t code = first & (0xFFu >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0u) != 0x80) return {first, 1, false};
    code = (code << 6) | (byte(i) & 0x3Fu);
  }
  const char32_t least = bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
  if (code < least || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {first, 1, false};
  return {code, bytes, true};
}

bool turnsDirection(char32_t c) {
  return c == 0x61C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

bool isObeyed(char32_t c) {
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029 || turnsDirection(c);
}

std::string shown(char32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\t') return "\\t";
  if (code == '\r') return "\\r";
  return code < 0x100 ? fmt::format("\\x{:02x}", static_cast<unsigned>(code))
                      : fmt::format("\\u{:04x}", static_cast<unsigned>(code));
}

// Each character of a text as it is shown.
class Shown {
 public:
  Shown(std::string_view text, bool keep_lines) {
    for (std::size_t i = 0; i < text.size(); ++count_) {
      const Character c = firstOf(text.substr(i));
      const bool kept = c.valid && (!isObeyed(c.code) || (keep_lines && c.code == '\n'));
      begins_.push_back(out_.size());
      out_ += kept ? std::string(text.substr(i, c.bytes)) : shown(c.code);
      i += c.bytes;
    }
    begins_.push_back(out_.size());
  }
  std::size_t count() const { return count_; }
  std::string_view all() const { return out_; }
  std::string_view first(std::size_t n) const { return std::string_view(out_).substr(0, begins_[n]); }
  std::string_view last(std::size_t n) const { return std::string_view(out_).substr(begins_[count_ - n]); }

 private:
  std::string out_;
  std::vector<std::size_t> begins_;  // of each character in out_, and its end
  std::size_t count_ = 0;
};

// The part of `text` in which `characters` of them have to lie: the rest needn't be looked at.
std::string_view frontOf(std::string_view text, std::size_t characters) { return text.substr(0, 4 * (characters + 1)); }

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
  const Shown front(frontOf(text, most), false);
  if (front.count() <= most && frontOf(text, most).size() == text.size()) return std::string(front.all());
  return fmt::format("{}... ({} bytes)", front.first(std::min(most, front.count())), text.size());
}

std::string printableMessage(std::string_view text) {
  constexpr std::size_t kHalf = kLongestMessage / 2;  // characters of the begin, and of the end
  if (text.size() <= 4 * kLongestMessage) {
    const Shown all(text, true);
    if (all.count() <= kLongestMessage) return std::string(all.all());
    return fmt::format("{} ... {}", all.first(kHalf), all.last(kHalf));
  }
  const Shown front(frontOf(text, kHalf), true), back(text.substr(text.size() - 4 * kHalf), true);
  return fmt::format("{} ... {}", front.first(kHalf), back.last(kHalf));
}

}  // namespace pincer
