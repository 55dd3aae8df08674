#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "pincer/devices/haply/json_walk.h"

namespace pincer::devices::haply {
namespace {

constexpr std::size_t kDeepest = 8, kLongestPath = 128;

// nlohmann's interface for a walk without a tree.
class Walker {
 public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  explicit Walker(JsonSink& sink) : sink_(sink) {}

  bool null() { return scalar(std::monostate{}); }
  bool boolean(bool value) { return scalar(value); }
  bool number_integer(number_integer_t value) { return scalar(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) { return scalar(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) { return scalar(value); }
  bool string(string_t& value) { return scalar(std::string_view(value)); }
  bool binary(binary_t&) { return false; }
  // A key's own dots become slashes, an empty key a slash: no name passes for another path.
  bool key(string_t& name) {
    if (name.empty()) name = "/";
    length_ = levels_[depth_ - 1].length;
    const std::size_t dot = length_ > 0 ? 1 : 0;
    if (length_ + dot + name.size() > path_.size()) return false;
    if (dot == 1) path_[length_++] = '.';
    for (const char c : name) path_[length_++] = c == '.' ? '/' : c;
    return true;
  }
  bool start_object(std::size_t) { return start(false); }
  bool start_array(std::size_t) { return start(true); }
  bool end_object() { return finish(false); }
  bool end_array() { return finish(true); }
  template <typename Error>
  bool parse_error(std::size_t, const std::string&, const Error&) {
    return false;
  }

 private:
  struct Level {
    std::size_t length = 0;  // of the path to it
  };
  std::string_view path() const { return {path_.data(), length_}; }
  // A value ends its key; an array's next element has the array's path again.
  void rest() { length_ = depth_ > 0 ? levels_[depth_ - 1].length : 0; }
  bool scalar(const JsonScalar& value) {
    const bool went_on = sink_.value(path(), value);
    rest();
    return went_on;
  }
  bool start(bool array) {
    if (depth_ == kDeepest) return false;
    levels_[depth_++] = {length_};
    return sink_.begin(path(), array);
  }
  bool finish(bool array) {
    length_ = levels_[--depth_].length;
    const bool went_on = sink_.end(path(), array);
    rest();
    return went_on;
  }

  JsonSink& sink_;
  std::array<char, kLongestPath> path_{};
  std::array<Level, kDeepest> levels_{};
  std::size_t depth_ = 0, length_ = 0;
};

}  // namespace

bool walkJson(std::string_view text, JsonSink& sink) noexcept {
  try {
    Walker walker(sink);
    return nlohmann::json::sax_parse(text.begin(), text.end(), &walker);
  } catch (...) {  // out of memory
    return false;
  }
}

}  // namespace pincer::devices::haply
