#include "pincer/tasks/app/schema_reference.h"

#include <fmt/format.h>

#include <algorithm>

namespace pincer::tasks {
namespace {

std::string memberText(const JsonValue& object, std::string_view key) {
  const JsonValue* found = object.find(key);
  return found ? found->text() : std::string();
}

// A value as it is written in a file.
std::string literal(const JsonValue& v) {
  switch (v.kind()) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return v.boolean() ? "true" : "false";
    case JsonValue::Kind::kNumber:
      return v.isWhole() ? std::to_string(v.whole()) : fmt::format("{}", v.number());
    case JsonValue::Kind::kString:
      return fmt::format("\"{}\"", v.text());
    case JsonValue::Kind::kArray:
    case JsonValue::Kind::kObject:
      break;
  }
  std::string list;
  for (const JsonValue& item : v.array()) list += (list.empty() ? "" : ", ") + literal(item);
  return "[" + list + "]";
}

std::string rangeOf(const JsonValue& schema) {
  const JsonValue* open = schema.find("exclusiveMinimum");
  const JsonValue* low = open ? open : schema.find("minimum");
  const JsonValue* high = schema.find("maximum");
  if (!low && !high) return "";
  return fmt::format(" in {}{}, {}", !low || open ? "(" : "[", low ? literal(*low) : "-inf",
                     high ? literal(*high) + "]" : "inf)");
}

class Reference {
 public:
  explicit Reference(const JsonValue& schema) : schema_(schema), defs_(schema.find("$defs")) {}

  std::string write() {
    out_ = fmt::format("# {}\n\n", schema_.at("title").text());
    if (const JsonValue* about = schema_.find("description")) out_ += about->text() + "\n\n";
    if (schema_.find("properties")) section("", schema_);
    if (defs_) {
      for (const std::string& name : defs_->keys()) {
        const JsonValue& def = defs_->at(name);
        if (hasSection(def)) section(name, def);
      }
    }
    return out_;
  }

 private:
  static bool isChoiceOfObjects(const JsonValue& schema) {
    const JsonValue* choice = schema.find("oneOf");
    return choice && !schema.find("properties") &&
           std::all_of(choice->array().begin(), choice->array().end(),
                       [](const JsonValue& o) { return o.find("$ref"); });
  }
  static bool hasSection(const JsonValue& def) { return def.find("properties") || isChoiceOfObjects(def); }

  void section(const std::string& name, const JsonValue& schema) {
    if (!name.empty()) out_ += fmt::format("## {}\n", name);
    if (isChoiceOfObjects(schema)) {
      out_ += fmt::format("{}\n\n", choiceText(schema.at("oneOf")));
      return;
    }
    out_ += demands(schema);
    out_ += "| key | value | default | meaning |\n|---|---|---|---|\n";
    const JsonValue& properties = schema.at("properties");
    std::vector<std::pair<std::string, const JsonValue*>> inner;
    for (const std::string& key : properties.keys()) {
      const JsonValue& property = properties.at(key);
      out_ += row(schema, key, property, inner, name);
    }
    out_ += "\n";
    for (const auto& [title, object] : inner) section(title, *object);
  }

  // Keys that must be there together.
  static std::string demands(const JsonValue& schema) {
    const JsonValue* choice = schema.find("oneOf");
    if (!choice) return "";
    std::string text;
    for (const JsonValue& option : choice->array()) {
      std::string keys;
      for (const JsonValue& key : option.at("required").array())
        keys += fmt::format("{}`{}`", keys.empty() ? "" : " and ", key.text());
      text += (text.empty() ? "" : ", or ") + keys;
    }
    return "Needs " + text + ", not both.\n\n";
  }

  std::string row(const JsonValue& owner, const std::string& key, const JsonValue& property,
                  std::vector<std::pair<std::string, const JsonValue*>>& inner, const std::string& path) {
    const std::string title = path.empty() ? key : path + "." + key;
    const JsonValue* object = property.find("properties") ? &property : property.find("items");
    if (object && object->find("properties")) inner.emplace_back(title, object);
    const JsonValue* standard = property.find("default");
    return fmt::format("| `{}` | {} | {} | {} |\n", key, valueText(property, title),
                       isRequired(owner, key) ? "needed" : (standard ? "`" + literal(*standard) + "`" : ""),
                       meaning(property));
  }

  static bool isRequired(const JsonValue& owner, const std::string& key) {
    const JsonValue* required = owner.find("required");
    if (!required) return false;
    return std::any_of(required->array().begin(), required->array().end(),
                       [&](const JsonValue& k) { return k.text() == key; });
  }

  // A scalar definition's description is its unit; the property's own comes after it.
  std::string meaning(const JsonValue& property) const {
    std::string text = memberText(property, "description");
    const JsonValue* def = property.find("$ref") ? &definition(property) : nullptr;
    const std::string unit = def && !hasSection(*def) ? memberText(*def, "description") : "";
    if (!unit.empty() && text.find(unit) == std::string::npos) text += (text.empty() ? "" : " ") + unit;
    return text;
  }

  const JsonValue& definition(const JsonValue& reference) const {
    const std::string& path = reference.at("$ref").text();
    return schema_.at("$defs").at(path.substr(path.rfind('/') + 1));
  }

  std::string valueText(const JsonValue& schema, const std::string& title) const {
    if (const JsonValue* reference = schema.find("$ref")) {
      const JsonValue& def = definition(schema);
      const std::string name = reference->text().substr(reference->text().rfind('/') + 1);
      return hasSection(def) ? fmt::format("[{}](#{})", name, name) : valueText(def, title);
    }
    if (const JsonValue* value = schema.find("const")) return "`" + literal(*value) + "`";
    if (const JsonValue* words = schema.find("enum")) return wordsText(*words);
    if (const JsonValue* choice = schema.find("oneOf"); choice && !schema.find("type")) return choiceText(*choice);
    const JsonValue& type = schema.at("type");
    if (type.kind() == JsonValue::Kind::kArray) return "number" + rangeOf(schema) + " or `null`";
    return typeText(type.text(), schema, title);
  }

  std::string typeText(const std::string& type, const JsonValue& schema, const std::string& title) const {
    if (type == "number") return "number" + rangeOf(schema);
    if (type == "integer") return "whole number" + rangeOf(schema);
    if (type == "boolean") return "`true` or `false`";
    if (type == "string") return schema.find("pattern") ? "letters, digits, - and _" : "text";
    if (type == "array") return listText(schema, title);
    const JsonValue* each = schema.find("additionalProperties");
    if (type == "object" && each && each->kind() == JsonValue::Kind::kObject)
      return "object: to each name a " + valueText(*each, title);
    if (type == "object")
      return schema.find("properties") && title.empty() ? pairText(schema, title)
                                                        : fmt::format("[object](#{})", anchor(title));
    schema.reject("has a type that the reference doesn't know.");
  }

  // A small object within a choice, written out.
  std::string pairText(const JsonValue& schema, const std::string& title) const {
    std::string text;
    const JsonValue& properties = schema.at("properties");
    for (const std::string& key : properties.keys())
      text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", key, valueText(properties.at(key), title));
    return "{" + text + "}";
  }

  std::string listText(const JsonValue& schema, const std::string& title) const {
    const JsonValue& items = schema.at("items");
    const JsonValue* most = schema.find("maxItems");
    const std::string each =
        items.find("properties") ? fmt::format("[objects](#{})", anchor(title)) : valueText(items, title);
    if (!most) return "list of " + each;
    return literal(*most) == "3" ? fmt::format("[x, y, z], each {}", each)
                                 : fmt::format("list of {}: {}", literal(*most), each);
  }

  std::string choiceText(const JsonValue& choice) const {
    std::string text;
    for (const JsonValue& option : choice.array()) text += (text.empty() ? "" : " or ") + valueText(option, "");
    return text;
  }

  static std::string wordsText(const JsonValue& words) {
    std::string text;
    for (const JsonValue& word : words.array()) text += (text.empty() ? "`" : ", `") + literal(word) + "`";
    return text;
  }

  static std::string anchor(std::string title) {
    std::erase(title, '.');
    return title;
  }

  const JsonValue& schema_;
  const JsonValue* defs_;
  std::string out_;
};

}  // namespace

std::string schemaMarkdown(const JsonValue& schema) { return Reference(schema).write(); }

}  // namespace pincer::tasks
