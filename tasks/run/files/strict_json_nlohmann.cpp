// The parser behind strict_json: nlohmann's, listened to event by event, because its own tree forgets the
// lines and keeps the last of two equal keys.
#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

// The line of the last character that the parser took and that isn't blank: the line on which the current token ends.
// (A number is only known to have ended once the character after it was taken; that one may be a line break.)
struct Cursor {
  int line = 1;
  int token_line = 1;

  void see(char c) {
    if (c == '\n') ++line;
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') token_line = line;
  }
};

class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Cursor* cursor) : at_(at), cursor_(cursor) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    cursor_->see(*at_++);
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  Cursor* cursor_;
};

// "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..." -> "syntax error ..."
std::string reasonOf(const std::string& what) {
  const std::size_t colon = what.find(": ");
  if (colon != std::string::npos) return what.substr(colon + 2);
  const std::size_t bracket = what.find("] ");
  return bracket == std::string::npos ? what : what.substr(bracket + 2);
}

}  // namespace

// Receives nlohmann's events and grows the tree.
class JsonTreeBuilder {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  JsonTreeBuilder(const std::string& file, const Cursor& cursor)
      : file_(std::make_shared<const std::string>(file)), cursor_(cursor) {}

  JsonValue takeRoot() { return std::move(root_); }

  bool null() { return add(JsonValue::Kind::kNull), true; }
  bool boolean(bool value) { return add(JsonValue::Kind::kBoolean).boolean_ = value, true; }
  bool number_integer(number_integer_t value) { return addNumber(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) { return addNumber(static_cast<double>(value), value); }
  bool number_float(number_float_t value, const string_t&) { return addNumber(value); }
  bool string(string_t& value) { return add(JsonValue::Kind::kString).text_ = value, true; }
  bool binary(binary_t&) { return false; }  // a JSON text holds none
  bool start_object(std::size_t) { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t) { return open(JsonValue::Kind::kArray); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(string_t& name) {
    if (!keys_.back().insert(name).second)
      fail(fmt::format("the key \"{}\" is there twice. Remove one of them.", printable(name)));
    open_.back()->keys_.push_back(name);
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) {
    constexpr std::size_t kLongestReason = 240;  // it repeats the file's last word
    fail(fmt::format("this isn't JSON: {}. Look for a missing comma, quote or bracket there or just before.",
                     printable(reasonOf(error.what()), kLongestReason)));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(fmt::format("{}:{}: {}", *file_, cursor_.token_line, problem));
  }

  JsonValue& add(JsonValue::Kind kind) {
    if (++count_ > kMostJsonValues) {
      fail(fmt::format(
          "there are more than {} values. Long lists go into files of their own: trajectories (CSV), meshes.",
          kMostJsonValues));
    }
    JsonValue& value = open_.empty() ? root_ : open_.back()->items_.emplace_back();
    value.kind_ = kind;
    value.line_ = cursor_.token_line;
    value.file_ = file_;
    if (!open_.empty()) value.path_ = pathInside(*open_.back());
    return value;
  }

  bool addNumber(double number, std::optional<std::uint64_t> exact = {}) {
    JsonValue& value = add(JsonValue::Kind::kNumber);
    value.number_ = number;
    value.exact_ = exact;
    return true;
  }

  bool open(JsonValue::Kind kind) {
    constexpr std::size_t kDeepest =
        32;  // scenes need 6; without a bound a file of brackets would exhaust the stack when the tree is freed
    if (open_.size() >= kDeepest) fail("brackets are nested more than 32 deep. No scene needs that.");
    open_.push_back(&add(kind));
    keys_.emplace_back();
    return true;
  }

  bool close() {
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  // Of the value that was just appended to `parent`. Every value has its path, so a
  // file of long keys must not make long ones.
  static std::string pathInside(const JsonValue& parent) {
    // Lengths of a key and of a path in a message [bytes]; chosen: a line that can be read.
    constexpr std::size_t kLongestKey = 40, kLongestPath = 160;
    const std::string& before = parent.path_;
    if (before.size() > kLongestPath) return before;
    if (parent.kind_ == JsonValue::Kind::kArray) return fmt::format("{}[{}]", before, parent.items_.size() - 1);
    return fmt::format("{}{}{}", before, before.empty() ? "" : ".", printable(parent.keys_.back(), kLongestKey));
  }

  std::shared_ptr<const std::string> file_;
  const Cursor& cursor_;
  JsonValue root_;
  std::vector<JsonValue*> open_;                       // from the root to the innermost open bracket
  std::vector<std::unordered_set<std::string>> keys_;  // of each of these, so far
  std::size_t count_ = 0;                              // of all values
};

JsonValue parseJson(std::string_view content, const std::string& name) {
  refuseNul(content, name);  // the parser takes it for the end
  Cursor cursor;
  JsonTreeBuilder builder(name, cursor);
  const char* begin = content.data();
  // The parser's switches: nothing may follow the value; comments are allowed.
  constexpr bool kWholeInput = true;
  constexpr bool kComments = true;
  nlohmann::json::sax_parse(CountingIterator(begin, &cursor), CountingIterator(begin + content.size(), &cursor),
                            &builder, nlohmann::json::input_format_t::json, kWholeInput, kComments);
  return builder.takeRoot();
}

}  // namespace pincer::tasks
