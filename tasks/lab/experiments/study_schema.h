// study_schema: the JSON Schema (draft 2020-12) of a study's file, by the lists of study_parameters.h: for
// editors, and for the reference in docs/.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "pincer/tasks/lab/experiments/study_names.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace pincer::tasks {

class SchemaWriter {
 public:
  // `published`: whose values are the defaults.
  template <HasParameters Study>
  std::string schemaOf(std::string_view title, const Study& published) {
    begin(title);
    file(published);
    return json_.endObject().text() + "\n";
  }

  // Of a file that names its experiment: the schema of that one holds.
  template <HasParameters... Study>
  std::string schemaOfAny(std::string_view title, const Study&... published) {
    begin(title);
    json_.key("type").value("object").key("required").beginArray().value(kExperimentKey).endArray();
    json_.key("properties").beginObject();
    experiment(kExperimentNames, "for which the file is: its keys are those of that one");
    json_.endObject().key("allOf").beginArray();
    (ifNamed(published), ...);
    return json_.endArray().endObject().text() + "\n";
  }

 private:
  void begin(std::string_view title) {
    json_.beginObject().key("$schema").value("https://json-schema.org/draft/2020-12/schema").key("title").value(title);
  }
  template <HasParameters Study>
  static std::vector<std::string_view> namesOf(const Study& study) {
    return {*std::find(kExperimentNames.begin(), kExperimentNames.end(), taskName(study))};
  }
  static std::vector<std::string_view> namesOf(const ManipulationStudy&) {
    return {kExperimentNames.end() - 3, kExperimentNames.end()};
  }
  void experiment(std::span<const std::string_view> names, std::string_view meaning) {
    json_.key(kExperimentKey).beginObject();
    words(names);
    json_.key("description").value(meaning).endObject();
  }
  template <HasParameters Study>
  void ifNamed(const Study& study) {
    json_.beginObject().key("if").beginObject().key("properties").beginObject();
    json_.key(kExperimentKey).beginObject();
    words(namesOf(study));
    json_.endObject().endObject().endObject().key("then").beginObject();
    file(study);
    json_.endObject().endObject();
  }

  template <HasParameters Study>
  void file(const Study& study) {
    json_.key("type").value("object").key("additionalProperties").value(false).key("properties").beginObject();
    json_.key("version").beginObject().key("const").value(1).endObject();
    experiment(namesOf(study), kExperimentMeaning);
    members(study);
    json_.endObject();
  }
  template <HasParameters Object>
  void object(const Object& o) {
    json_.key("type").value("object").key("additionalProperties").value(false).key("properties").beginObject();
    members(o);
    json_.endObject();
  }
  template <HasParameters Object>
  void members(const Object& o) {
    visitParameters(o, [&](std::string_view key, const auto& field, const Parameter& parameter) {
      json_.key(key).beginObject();
      describe(field, parameter);
      if (!parameter.meaning.empty()) json_.key("description").value(parameter.meaning);
      json_.endObject();
    });
  }

  void range(const Parameter& p) {
    if (std::isfinite(p.rule.min)) json_.key(p.rule.min_open ? "exclusiveMinimum" : "minimum").value(p.rule.min);
    if (std::isfinite(p.rule.max)) json_.key("maximum").value(p.rule.max);
  }
  void words(std::span<const std::string_view> choices, bool or_null = false) {
    json_.key("enum").beginArray();
    for (const std::string_view word : choices) json_.value(word);
    if (or_null) json_.value(std::nan(""));
    json_.endArray();
  }
  template <class Value>
  void standard(const Value& value) {
    if (in_list_ == 0) json_.key("default").value(value);
  }

  void describe(double field, const Parameter& p) {
    json_.key("type");
    p.may_be_null ? json_.beginArray().value("number").value("null").endArray() : json_.value("number");
    range(p);
    standard(field);
  }
  void describe(int field, const Parameter& p) {
    json_.key("type").value("integer");
    range(p);
    standard(field);
  }
  void describe(std::uint64_t field, const Parameter&) {
    json_.key("type").value("integer").key("minimum").value(0).key("maximum").value(kLargestSeed);
    standard(field);
  }
  void describe(bool field, const Parameter&) {
    json_.key("type").value("boolean");
    standard(field);
  }
  void describe(const std::string& field, const Parameter&) {
    json_.key("type").value("string");
    if (!field.empty()) standard(field);
  }
  template <class Word>
  requires std::is_enum_v<Word>
  void describe(Word field, const Parameter& p) {
    words(p.words);
    standard(p.words[static_cast<std::size_t>(field)]);
  }
  template <HasParameters Object>
  void describe(const Object& field, const Parameter&) {
    object(field);
  }
  template <class Field>
  void describe(const std::optional<Field>& field, const Parameter& p) {
    ++in_list_;  // no default: it may be missing
    if constexpr (std::is_enum_v<Field>) {
      words(p.words, true);
    } else {
      describe(field.value_or(Field{}), p);
    }
    --in_list_;
  }
  // Items have no defaults of their own: one begins as the published item of its name.
  template <class Item>
  void describe(const std::vector<Item>&, const Parameter& p) {
    ++in_list_;
    json_.key("type").value("array");
    if constexpr (!std::same_as<Item, SurveyItem> && !std::same_as<Item, std::string>) json_.key("minItems").value(1);
    json_.key("items").beginObject();
    describe(Item{}, p);
    json_.endObject();
    --in_list_;
  }

  JsonWriter json_;
  int in_list_ = 0;
};

}  // namespace pincer::tasks
