#include "pincer/tasks/run/session/session_conditions.h"

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {
namespace {

// Sessions of before conditions were data name them alone.
std::pair<std::string, std::string> labelled(const JsonValue& condition) {
  if (condition.kind() == JsonValue::Kind::kString) return {condition.text(), publishedLabel(condition.text())};
  const std::string &name = condition.at("name").text(), &label = condition.at("label").text();
  return {name, label.empty() ? name : label};
}

}  // namespace

std::string publishedLabel(const std::string& condition) {
  if (condition == "force") return "force only";
  return condition == "cld+force" ? "CLD + force" : condition;
}

ConditionLabels conditionLabels(const SessionInfo& info) {
  ConditionLabels labels;
  try {
    const JsonValue protocol = parseJson(info.protocol_json, "protocol");
    const JsonValue* list = protocol.find("conditions");
    if (!list) return {};
    for (const JsonValue& condition : list->array()) labels.push_back(labelled(condition));
  } catch (const InputError&) {
    labels.clear();
  }
  return labels;
}

}  // namespace pincer::tasks
