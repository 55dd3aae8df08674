#include "pincer/tasks/run/scene/json_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/scene/scene_keys.h"

namespace pincer::tasks {
namespace {

// A step of a path: a key, or a place in a list.
struct PathStep {
  std::string key;
  std::optional<std::size_t> index;
};

[[noreturn]] void refusePath(std::string_view path) {
  throw InputError(
      fmt::format("\"{}\" isn't the path of a number. Write it as messages do: bodies[0].material.mu_s", path));
}

// "[12]" at the front of `rest`, which is moved on.
std::size_t takeIndex(std::string_view path, std::string_view& rest) {
  std::size_t index = 0;
  const char* end = rest.data() + rest.size();
  const auto read = std::from_chars(rest.data() + 1, end, index);
  if (read.ec != std::errc{} || read.ptr == end || *read.ptr != ']') refusePath(path);
  rest.remove_prefix(static_cast<std::size_t>(read.ptr + 1 - rest.data()));
  return index;
}

std::vector<PathStep> stepsOf(std::string_view path) {
  std::vector<PathStep> steps;
  for (std::string_view rest = path; !rest.empty();) {
    if (rest.front() == '[') {
      steps.push_back({"", takeIndex(path, rest)});
      continue;
    }
    if (!steps.empty()) {
      if (rest.front() != '.') refusePath(path);
      rest.remove_prefix(1);
    }
    const std::string_view key = rest.substr(0, rest.find_first_of(".["));
    if (key.empty()) refusePath(path);
    steps.push_back({std::string(key), {}});
    rest.remove_prefix(key.size());
  }
  if (steps.empty() || steps.front().index) refusePath(path);
  return steps;
}

}  // namespace

class JsonChange {
 public:
  static void set(JsonValue& file, std::string_view path, double value) {
    JsonValue* at = &file;
    for (const PathStep& step : stepsOf(path)) at = step.index ? &element(*at, *step.index) : &member(*at, step.key);
    const bool is_new = at->kind_ == JsonValue::Kind::kNull;
    if (!is_new && at->kind_ != JsonValue::Kind::kNumber) at->reject("is no number: nothing else can be varied.");
    at->kind_ = JsonValue::Kind::kNumber;
    at->number_ = value;
    at->exact_.reset();
  }

 private:
  static JsonValue& element(JsonValue& list, std::size_t index) {
    const std::size_t size = list.array().size();
    if (index >= size) list.reject(fmt::format("has {} elements; there is no [{}]: they count from 0.", size, index));
    return list.items_[index];
  }
  static JsonValue& member(JsonValue& object, const std::string& key) {
    if (object.kind_ == JsonValue::Kind::kNull) object.kind_ = JsonValue::Kind::kObject;  // one that was added
    const auto found = std::find(object.keys().begin(), object.keys().end(), key);
    if (found != object.keys().end()) return object.items_[static_cast<std::size_t>(found - object.keys().begin())];
    object.keys_.push_back(key);
    JsonValue& added = object.items_.emplace_back();
    added.line_ = object.line_;
    added.file_ = object.file_;
    added.path_ = object.path_.empty() ? key : object.path_ + "." + key;
    return added;
  }
};

void setNumber(JsonValue& file, std::string_view path, double value) { JsonChange::set(file, path, value); }

const JsonValue& nearestTo(const JsonValue& file, std::string_view path) {
  const JsonValue* at = &file;
  for (const PathStep& step : stepsOf(path)) {
    const JsonValue* next = nullptr;
    if (step.index && at->kind() == JsonValue::Kind::kArray && *step.index < at->array().size())
      next = &at->array()[*step.index];
    if (!step.index && at->kind() == JsonValue::Kind::kObject) next = at->find(step.key);
    if (!next) break;
    at = next;
  }
  return *at;
}

std::string scenePath(const JsonValue& scene, std::string_view path) {
  const std::string first = stepsOf(path).front().key;
  std::vector<std::string_view> known(std::begin(keys::kScene), std::end(keys::kScene));
  if (std::find(known.begin(), known.end(), first) != known.end()) return std::string(path);
  for (const char* list : {"bodies", "joints", "fingers"}) {
    const JsonValue* objects = scene.find(list);
    for (std::size_t i = 0; objects && i < objects->array().size(); ++i) {
      const JsonValue* name = objects->array()[i].find("name");
      if (name && name->text() == first) return fmt::format("{}[{}]{}", list, i, path.substr(first.size()));
      if (name) known.push_back(name->text());
    }
  }
  throw InputError(fmt::format("\"{}\": the scene has neither a key nor a body, joint or finger \"{}\".{}", path, first,
                               suggestion(first, known)));
}

}  // namespace pincer::tasks
