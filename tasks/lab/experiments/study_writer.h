// study_writer: a study's parameters as its file: every value, and behind it what it means as a comment. Of the items
// of a list only the first is explained. Numbers have the fewest digits that read back to the same bits.
//
//   studyText(study)   the file; study_reader.h reads it
#pragma once
#include <cmath>

#include "pincer/tasks/lab/experiments/study_names.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/run/files/json_writer.h"

namespace pincer::tasks {

// Lines of JSON, with comments behind them.
class CommentedJson {
 public:
  void value(std::string_view json, std::string_view comment);
  void key(std::string_view name);
  void open(char bracket);
  void close(char bracket);
  const std::string& text();

  bool explains = true;  // false: comments are left out

 private:
  void endLine(bool comma);

  std::string text_, indent_, comment_, key_;
  bool pending_ = false;  // a value whose line isn't ended
};

inline std::string jsonOf(double field, const Parameter&) {
  return std::isfinite(field) ? fmt::format("{}", field) : "null";
}
inline std::string jsonOf(int field, const Parameter&) { return std::to_string(field); }
inline std::string jsonOf(std::uint64_t field, const Parameter&) { return std::to_string(field); }
inline std::string jsonOf(bool field, const Parameter&) { return field ? "true" : "false"; }
inline std::string jsonOf(const std::string& field, const Parameter&) { return quotedJson(field); }
template <class Word>
requires std::is_enum_v<Word> std::string jsonOf(Word field, const Parameter& parameter) {
  return quotedJson(parameter.words[static_cast<std::size_t>(field)]);
}

template <class Field>
requires(!HasParameters<Field>) void writeField(CommentedJson& out, const Field& field, const Parameter& parameter) {
  out.value(jsonOf(field, parameter), parameter.meaning);
}

template <HasParameters Object>
void writeMembers(CommentedJson& out, const Object& object) {
  visitParameters(object, [&]<class Field>(std::string_view key, const Field& field, const Parameter& parameter) {
    if constexpr (std::same_as<Field, SurveyPlan>) {
      // as given: hundreds of lines that say nothing new
      if (field == manipulationSurvey() || field == oneFingerSurvey()) return;
    }
    out.key(key);
    writeField(out, field, parameter);
  });
}

template <HasParameters Object>
void writeField(CommentedJson& out, const Object& object, const Parameter&) {
  out.open('{');
  writeMembers(out, object);
  out.close('}');
}

template <class Field>
void writeField(CommentedJson& out, const std::optional<Field>& field, const Parameter& parameter) {
  field ? writeField(out, *field, parameter) : out.value("null", parameter.meaning);
}

template <class Item>
void writeField(CommentedJson& out, const std::vector<Item>& field, const Parameter& parameter) {
  if constexpr (HasParameters<Item>) {
    const bool explains = out.explains;
    out.open('[');
    for (const Item& item : field) {
      writeField(out, item, parameter);
      out.explains = false;
    }
    out.explains = explains;
    out.close(']');
  } else {
    std::string list;
    for (const Item& item : field) list += (list.empty() ? "" : ", ") + jsonOf(item, parameter);
    out.value("[" + list + "]", parameter.meaning);
  }
}

template <HasParameters Study>
std::string studyText(const Study& study) {
  CommentedJson out;
  out.open('{');
  out.key("version");
  out.value("1", "of this format");
  out.key(kExperimentKey);
  out.value(quotedJson(taskName(study)), kExperimentMeaning);
  writeMembers(out, study);
  out.close('}');
  return out.text();
}

}  // namespace pincer::tasks
