// study_reader: readStudyText(): a study's parameters from its file (tasks/run/files/strict_json.h), by the lists of
// study_parameters.h. What the file leaves out stays as it is; a key that no list has, a number out of its range, a
// word that isn't known: InputError with file, line, path, value and remedy.
#pragma once
#include <cmath>
#include <initializer_list>

#include "pincer/tasks/lab/experiments/study_names.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/scene/json_change.h"

namespace pincer::tasks {

template <HasParameters Object>
void readParameters(const JsonValue& json, Object& object, std::initializer_list<std::string_view> more_keys = {});

inline void readField(const JsonValue& v, double& field, const Parameter& parameter) {
  field = parameter.may_be_null && v.kind() == JsonValue::Kind::kNull ? std::nan("") : v.number(parameter.rule);
}
inline void readField(const JsonValue& v, int& field, const Parameter& parameter) {
  const double value = v.number(parameter.rule);
  if (value != std::floor(value) || std::abs(value) > 1e9) v.reject("isn't a whole number.");
  field = static_cast<int>(value);
}
inline void readField(const JsonValue& v, std::uint64_t& field, const Parameter&) { field = v.whole(); }
inline void readField(const JsonValue& v, bool& field, const Parameter&) { field = v.boolean(); }
inline void readField(const JsonValue& v, std::string& field, const Parameter&) { field = v.text(); }

template <class Word>
requires std::is_enum_v<Word>
void readField(const JsonValue& v, Word& field, const Parameter& parameter) {
  field = static_cast<Word>(v.oneOf(parameter.words));
}

template <HasParameters Object>
void readField(const JsonValue& v, Object& field, const Parameter&) {
  readParameters(v, field);
}

template <class Field>
void readField(const JsonValue& v, std::optional<Field>& field, const Parameter& parameter) {
  field.reset();
  if (v.kind() != JsonValue::Kind::kNull) readField(v, field.emplace(), parameter);
}

// An item of a list, or its name alone: one with the name of a published one begins as that; one with a new name as
// the first, but for what is said of that one alone: it is labelled by its name, and nothing was published of it.
template <class Item>
Item namedItem(const JsonValue& json, const std::vector<Item>& known) {
  const bool only_named = json.kind() == JsonValue::Kind::kString;
  const std::string& name = only_named ? json.text() : json.at("name", "Each condition has one.").text();
  for (const Item& item : known)
    if (item.name == name) return item;
  Item item = known.empty() ? Item{} : known.front();
  item.name = item.label = name;
  if constexpr (requires { item.published; }) item.published = std::nan("");
  return item;
}

// A list in place of the one that was there.
template <class Item>
void readField(const JsonValue& v, std::vector<Item>& field, const Parameter& parameter) {
  std::vector<Item> list;
  if (v.array().size() > kMostInStudyList)
    v.reject(fmt::format("has {} elements; at most {} are allowed.", v.array().size(), kMostInStudyList));
  for (const JsonValue& json : v.array()) {
    Item item{};
    if constexpr (requires {
                    item.name;
                    item.label;
                  }) {
      item = namedItem(json, field);
      if (json.kind() != JsonValue::Kind::kString) readField(json, item, parameter);
    } else {
      readField(json, item, parameter);
    }
    list.push_back(std::move(item));
  }
  field = std::move(list);
}

template <HasParameters Object>
void readParameters(const JsonValue& json, Object& object, std::initializer_list<std::string_view> more_keys) {
  std::vector<std::string_view> keys(more_keys);
  visitParameters(object, [&](std::string_view key, auto& field, const Parameter& parameter) {
    keys.push_back(key);
    if (const JsonValue* found = json.find(key)) readField(*found, field, parameter);
  });
  json.allowOnly(keys);
}

// The experiment that runs once the file is read: of a manipulation study, its list of tasks decides.
template <HasParameters Study>
std::string experimentAfter(const JsonValue&, const Study& study) {
  return taskName(study);
}
inline std::string experimentAfter(const JsonValue& file, ManipulationStudy study) {
  if (const JsonValue* tasks = file.find("tasks")) readField(*tasks, study.tasks, Parameter{"", {}, kHandTaskNames});
  return taskName(study);
}

// The whole file. "version" and "experiment" may be left out. What two parameters demand of each other is asked here
// as well.
template <HasParameters Study>
void readStudyText(const JsonValue& file, Study& study) {
  if (const JsonValue* version = file.find("version"); version && version->number() != 1)
    version->reject("is unknown. This pincer reads version 1.");
  requireExperiment(file, experimentAfter(file, study));  // before keys that only the other experiment knows
  readParameters(file, study, {"version", kExperimentKey});
  try {
    validate(study);
  } catch (const ParameterError& error) {
    throw InputError(fmt::format("{}: {}", nearestTo(file, error.path()).place(), error.what()));
  }
}

}  // namespace pincer::tasks
