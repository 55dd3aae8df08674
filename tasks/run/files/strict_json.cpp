#include "pincer/tasks/run/files/strict_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {
namespace {

std::string withSpace(std::string_view sentence) {
  return sentence.empty() ? std::string() : fmt::format(" {}", sentence);
}

}  // namespace

std::string rangeText(const NumberRule& rule) {
  const bool unbounded = std::isinf(rule.max);
  const bool unbounded_below = std::isinf(rule.min);
  return fmt::format("{}{}{}, {}{}", rule.or_zero ? "0 or " : "", rule.min_open || unbounded_below ? '(' : '[',
                     rule.min, rule.max, unbounded ? ')' : ']');
}

bool isWithin(double value, const NumberRule& rule) {
  if (rule.or_zero && value == 0) return true;
  return (rule.min_open ? value > rule.min : value >= rule.min) && value <= rule.max;
}

std::string outOfRange(const NumberRule& rule) {
  return fmt::format("is out of range {}.{}", rangeText(rule), withSpace(rule.remedy));
}

bool JsonValue::boolean() const {
  require(Kind::kBoolean, "true or false");
  return boolean_;
}

double JsonValue::number(const NumberRule& rule) const {
  require(Kind::kNumber, "a number");
  if (!isWithin(number_, rule)) reject(outOfRange(rule));
  return number_;
}

int JsonValue::integer(int min, int max, std::string_view remedy) const {
  const double value = number({.min = static_cast<double>(min), .max = static_cast<double>(max), .remedy = remedy});
  if (value != std::floor(value)) reject(fmt::format("isn't a whole number.{}", withSpace(remedy)));
  return static_cast<int>(value);
}

std::uint64_t JsonValue::whole() const {
  constexpr double kExactBelow = 9007199254740992;  // 2^53: so far 1e3 is the same as 1000
  const double value = number();
  if (exact_) return *exact_;
  if (value >= 0 && value <= kExactBelow && value == std::floor(value)) return static_cast<std::uint64_t>(value);
  reject("isn't a whole number in [0, 18446744073709551615]. Take for example 1.");
}

const std::string& JsonValue::text() const {
  require(Kind::kString, "a text in quotes");
  return text_;
}

Vec3 JsonValue::vector(const NumberRule& each) const {
  const std::vector<JsonValue>& items = array();
  if (items.size() != 3) reject(fmt::format("has {} elements, but a vector has three: [x, y, z].", items.size()));
  return {items[0].number(each), items[1].number(each), items[2].number(each)};
}

const std::vector<JsonValue>& JsonValue::array() const {
  require(Kind::kArray, "a list in brackets");
  return items_;
}

const std::vector<std::string>& JsonValue::keys() const {
  require(Kind::kObject, "an object in braces");
  return keys_;
}

const JsonValue* JsonValue::find(std::string_view key) const {
  require(Kind::kObject, "an object in braces");
  const auto it = std::find(keys_.begin(), keys_.end(), key);
  return it == keys_.end() ? nullptr : &items_[static_cast<std::size_t>(it - keys_.begin())];
}

const JsonValue& JsonValue::at(std::string_view key, std::string_view remedy) const {
  const JsonValue* value = find(key);
  if (!value) reject(fmt::format("lacks the key \"{}\".{}", key, withSpace(remedy)));
  return *value;
}

void JsonValue::allowOnly(std::span<const std::string_view> keys) const {
  require(Kind::kObject, "an object in braces");
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (std::find(keys.begin(), keys.end(), keys_[i]) != keys.end()) continue;
    throw InputError(
        fmt::format("{}: {} isn't a known key.{}", items_[i].place(), items_[i].path_, suggestion(keys_[i], keys)));
  }
}

std::size_t JsonValue::oneOf(std::span<const std::string_view> words) const {
  const auto it = std::find(words.begin(), words.end(), text());
  if (it == words.end()) reject(fmt::format("isn't known.{}", suggestion(text_, words)));
  return static_cast<std::size_t>(it - words.begin());
}

std::string JsonValue::place() const { return fmt::format("{}:{}", *file_, line_); }

void JsonValue::reject(std::string_view problem) const {
  const std::string subject = path_.empty() ? "the whole file" : path_;
  const std::string value = shown();
  throw InputError(fmt::format("{}: {}{}{} {}", place(), subject, value.empty() ? "" : " = ", value, problem));
}

void JsonValue::require(Kind kind, std::string_view what) const {
  if (kind_ != kind) reject(fmt::format("has the wrong type: {} is needed here.", what));
}

std::string JsonValue::shown() const {
  switch (kind_) {
    case Kind::kNull:
      return "null";
    case Kind::kBoolean:
      return boolean_ ? "true" : "false";
    case Kind::kNumber:
      return exact_ ? std::to_string(*exact_) : fmt::format("{}", number_);
    case Kind::kString:
      return fmt::format("\"{}\"", printable(text_));
    case Kind::kArray:
    case Kind::kObject:
      return "";
  }
  return "";
}

JsonValue readJson(const std::string& path, const InputKind& kind) {
  const std::string content = readInputFile(path, kind);
  if (content.empty()) throw InputError(fmt::format("{}: the file is empty; {} is needed here.", path, kind.name));
  return parseJson(content, path);
}

}  // namespace pincer::tasks
