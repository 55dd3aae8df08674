#include <simdjson.h>

#include <array>
#include <cstddef>

#include "pincer/devices/haply/json_walk.h"

namespace pincer::devices::haply {
namespace {

namespace dom = simdjson::dom;

constexpr std::size_t kDeepest = 8, kLongestPath = 128;  // objects within objects; characters

JsonScalar scalarOf(const dom::element& element) {
  switch (element.type()) {
    case dom::element_type::STRING:
      return std::string_view(element);
    case dom::element_type::BOOL:
      return bool(element);
    case dom::element_type::NULL_VALUE:
      return std::monostate{};
    default:
      return double(element);
  }
}

// Goes through a parsed text and keeps the path.
class Walker {
 public:
  explicit Walker(JsonSink& sink) : sink_(sink) {}

  bool walk(const dom::element& element) {
    if (element.is_object()) return walkObject(dom::object(element));
    if (element.is_array()) return walkArray(dom::array(element));
    return sink_.value(path(), scalarOf(element));
  }

 private:
  std::string_view path() const { return {path_.data(), length_}; }
  bool begin(bool array) { return ++depth_ <= kDeepest && sink_.begin(path(), array); }
  bool end(bool array) {
    --depth_;
    return sink_.end(path(), array);
  }
  bool walkObject(const dom::object& object) {
    const std::size_t length = length_;
    if (!begin(false)) return false;
    for (const dom::key_value_pair& member : object) {
      if (!append(member.key) || !walk(member.value)) return false;
      length_ = length;
    }
    return end(false);
  }
  bool walkArray(const dom::array& array) {
    if (!begin(true)) return false;
    for (const dom::element& element : array) {
      if (!walk(element)) return false;
    }
    return end(true);
  }
  // A key's own dots become slashes, an empty key a slash: no name passes for another path.
  bool append(std::string_view name) {
    if (name.empty()) name = "/";
    const std::size_t dot = length_ > 0 ? 1 : 0;
    if (length_ + dot + name.size() > path_.size()) return false;
    if (dot == 1) path_[length_++] = '.';
    for (const char c : name) path_[length_++] = c == '.' ? '/' : c;
    return true;
  }

  JsonSink& sink_;
  std::array<char, kLongestPath> path_{};
  std::size_t length_ = 0, depth_ = 0;
};

}  // namespace

bool walkJson(std::string_view text, JsonSink& sink) noexcept {
  try {
    dom::parser parser;
    dom::element root;
    // The parser's own depth counts from 1, and stops it before this program's stack ends.
    if (parser.allocate(text.size(), kDeepest + 1) != simdjson::SUCCESS) return false;
    return parser.parse(text.data(), text.size()).get(root) == simdjson::SUCCESS && Walker(sink).walk(root);
  } catch (...) {  // out of memory
    return false;
  }
}

}  // namespace pincer::devices::haply
