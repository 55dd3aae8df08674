// strict_json: a JSON file (comments allowed) read so that every mistake in it is
// named: file, line, path, value, range, remedy.
//
//   scenes/pickup.json:14: bodies[0].material.mu_s = -0.3 is out of range [0, inf). A
//   friction coefficient can't be negative; ...
//
// Duplicate keys are errors. A number is finite; "NaN" and numbers beyond the range of doubles don't parse.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/io/input_file.h"
#include "pincer/contact/math.h"

namespace pincer::tasks {

// Where a number may lie, and what to tell somebody whose number doesn't.
struct NumberRule {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  // min itself is excluded
  std::string_view remedy = "";
  bool or_zero = false;  // 0 is allowed although it lies below min
};
bool isWithin(double value, const NumberRule& rule);  // false for NaN
std::string rangeText(const NumberRule& rule);        // "[0, inf)"
// "is out of range [0, inf). <remedy>"
std::string outOfRange(const NumberRule& rule);

class JsonValue {
 public:
  enum class Kind { kNull, kBoolean, kNumber, kString, kArray, kObject };

  Kind kind() const { return kind_; }
  const std::string& path() const { return path_; }
  int line() const { return line_; }
  std::string place() const;  // "file:line"

  // The value as what it must be; each throws InputError when it is something else.
  bool boolean() const;
  double number(const NumberRule& rule = {}) const;
  int integer(int min, int max, std::string_view remedy) const;
  std::uint64_t whole() const;                         // in [0, 2^64 - 1], all bits as they are written
  bool isWhole() const { return exact_.has_value(); }  // written as a whole number of that range
  const std::string& text() const;
  Vec3 vector(const NumberRule& each = {}) const;  // [x, y, z]
  const std::vector<JsonValue>& array() const;

  const std::vector<std::string>& keys() const;  // of an object, in the file's order

  // Members of an object. `find` gives nullptr when the key is missing, `at` throws and adds `remedy`.
  const JsonValue* find(std::string_view key) const;
  const JsonValue& at(std::string_view key, std::string_view remedy = "") const;
  // Throws for the first key that isn't one of `keys`, with a did-you-mean.
  void allowOnly(std::span<const std::string_view> keys) const;

  // The index of this text in `words`; throws with a did-you-mean when it is none of them.
  std::size_t oneOf(std::span<const std::string_view> words) const;

  // Throws InputError: "file:line: path = value <problem>".
  [[noreturn]] void reject(std::string_view problem) const;

 private:
  friend class JsonTreeBuilder;
  friend class JsonChange;
  void require(Kind kind, std::string_view what) const;
  std::string shown() const;

  Kind kind_ = Kind::kNull;
  bool boolean_ = false;
  double number_ = 0;
  std::optional<std::uint64_t> exact_;  // the same, of a whole number: above 2^53 doubles have gaps
  std::string text_;
  std::vector<JsonValue> items_;   // of an array or object
  std::vector<std::string> keys_;  // of an object, one per item
  std::string path_;               // "bodies[0].material.mu_s", printable; empty for the whole file
  int line_ = 1;
  std::shared_ptr<const std::string> file_;
};

// Reads the file at `path`, or parses `content` with `name` standing for the file in messages. Throws InputError.
// Values, keys and paths of the file stand in messages as printable() shows them, cut.
JsonValue readJson(const std::string& path, const InputKind& kind);
JsonValue parseJson(std::string_view content, const std::string& name);

}  // namespace pincer::tasks
