#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tests/fuzz/choices.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

using tasks::JsonValue;

constexpr int kDeepest = 10;  // a scene's own nesting is 7

const JsonValue& schema() {
  static const JsonValue kSchema = tasks::parseJson(tasks::sceneSchema(), "scene.schema.json");
  return kSchema;
}

// Where a "$ref" leads: "#/$defs/vector".
const JsonValue& resolved(const JsonValue& node) {
  const JsonValue* ref = node.find("$ref");
  if (ref == nullptr) return node;
  const std::string& place = ref->text();
  return resolved(schema().at("$defs").at(std::string_view(place).substr(place.rfind('/') + 1)));
}

// Writes a document that a schema allows: any of its keys, numbers in their range and beyond it.
class SceneDrawer {
 public:
  explicit SceneDrawer(Choices& choices) : choices_(choices) {}

  std::string draw(const JsonValue& unresolved, int depth = 0) {
    const JsonValue& node = resolved(unresolved);
    if (const JsonValue* value = node.find("const")) return plain(*value);
    if (const JsonValue* words = node.find("enum")) return plain(words->array()[choices_.below(words->array().size())]);
    if (const JsonValue* forms = node.find("oneOf"))
      return draw(forms->array()[choices_.below(forms->array().size())], depth);
    const JsonValue* type = node.find("type");
    const std::string& name = type != nullptr && type->kind() == JsonValue::Kind::kString ? type->text() : kObject;
    if (name == "number" || name == "integer") return number(node, name == "integer");
    if (name == "boolean") return choices_.below(2) == 0 ? "true" : "false";
    if (name == "string") return text();
    if (name == "array") return array(node, depth);
    return object(node, depth);
  }

 private:
  inline static const std::string kObject = "object";

  static std::string plain(const JsonValue& value) {
    if (value.kind() == JsonValue::Kind::kString) return fmt::format("\"{}\"", value.text());
    return value.kind() == JsonValue::Kind::kNumber ? fmt::format("{}", value.number()) : "null";
  }
  std::string number(const JsonValue& node, bool whole) {
    const JsonValue* least = node.find("minimum");
    const JsonValue* most = node.find("maximum");
    constexpr std::array kUsual = {0.02, 0.5, 1.0, 0.001, 3.0, 0.1, -0.02, 10.0};
    const std::size_t which = choices_.below(12);
    double value = which < kUsual.size() ? kUsual[which] : 0;
    if (which == 9 && least != nullptr) value = least->number();
    if (which == 10 && most != nullptr) value = most->number();
    return whole ? fmt::format("{}", static_cast<long>(value)) : fmt::format("{}", value);
  }
  // Names are few, so that parts find each other.
  std::string text() {
    constexpr std::array kNames = {"a", "b", "a.x", "b.p.z", "1 N", "a_b"};
    return fmt::format("\"{}\"", kNames[choices_.below(kNames.size())]);
  }
  std::string array(const JsonValue& node, int depth) {
    const JsonValue* least = node.find("minItems");
    std::size_t n = least != nullptr ? static_cast<std::size_t>(least->number()) : 0;
    if (!choices_.empty() && depth < kDeepest) n += choices_.below(3);
    std::vector<std::string> items;
    const JsonValue* item = node.find("items");
    for (std::size_t i = 0; item != nullptr && i < n; ++i) items.push_back(draw(*item, depth + 1));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  bool isRequired(const JsonValue& node, const std::string& key) {
    const JsonValue* required = node.find("required");
    for (std::size_t i = 0; required != nullptr && i < required->array().size(); ++i)
      if (required->array()[i].text() == key) return true;
    return false;
  }
  std::string object(const JsonValue& node, int depth) {
    std::vector<std::string> members;
    const JsonValue* properties = node.find("properties");
    if (properties == nullptr) return "{}";
    for (const std::string& key : properties->keys()) {
      const bool wanted = isRequired(node, key) || (!choices_.empty() && depth < kDeepest && choices_.below(3) == 1);
      if (wanted) members.push_back(fmt::format("\"{}\": {}", key, draw(properties->at(key), depth + 1)));
    }
    return fmt::format("{{{}}}", fmt::join(members, ", "));
  }

  Choices& choices_;
};

}  // namespace

void scene_schema(Bytes input) {
  Choices choices(input);
  const std::string text = SceneDrawer(choices).draw(schema());
  try {
    tasks::buildWorld(tasks::parseScene(text, "/nowhere/fuzz.json"));
  } catch (const InputError& refusal) {
    const bool unknown = std::string_view(refusal.what()).find("isn't a known key") != std::string_view::npos;
    if (unknown) fmt::print(stderr, "{}\n{}\n", text, refusal.what());
    demand(!unknown, "the reader knows every key that the schema has");
    demand(isForPeople(refusal.what()), "a refusal is a sentence that a terminal can show");
  }
}

}  // namespace pincer::fuzz
