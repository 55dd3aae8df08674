#include "pincer/tasks/run/session/bids_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <type_traits>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/session/column_meanings.h"
#include "pincer/tasks/run/session/table.h"

namespace pincer::tasks {
namespace {

// BIDS labels hold letters and digits only, and at least one; 60 leave room for the rest of a file's name.
std::string bidsLabel(const std::string& text) {
  std::string label;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) && label.size() < 60) label += c;
  }
  return label.empty() ? "unnamed" : label;
}

std::string subjectOf(std::int64_t participant) { return fmt::format("sub-{:02}", participant + 1); }

// BIDS knows no quotes: a tab or line end in a text is written \\t, \\n or \\r, a backslash
// twice. Spreadsheets read these files too.
std::string tsvText(const std::string& text) {
  if (text.empty()) return "n/a";
  std::string field;
  for (const char c : spreadsheetText(text)) {
    switch (c) {
      case '\t':
        field += "\\t";
        break;
      case '\n':
        field += "\\n";
        break;
      case '\r':
        field += "\\r";
        break;
      case '\\':
        field += "\\\\";
        break;
      default:
        field += c;
    }
  }
  return field;
}

template <class Field>
std::string tsvField(const Field& field) {
  if constexpr (std::is_floating_point_v<Field>) {
    return field != field ? "n/a" : fmt::format("{}", field);
  } else if constexpr (std::is_same_v<Field, std::string>) {
    return tsvText(field);
  } else {
    return fmt::format("{}", field);
  }
}

// Participants by the name that their files have; what is counted, from 1.
template <class Field>
std::string fieldOf(const ColumnName& name, const Field& field) {
  if constexpr (std::is_same_v<Field, std::int64_t>) {
    return name.quantity == "participant" ? subjectOf(field) : tsvField(field + countsFrom(name));
  } else {
    return tsvField(field);
  }
}

// A column's entry: description, unit and levels, as BIDS has them.
std::string describedJson(const ColumnMeaning& meaning) {
  std::string json = fmt::format("{{\"Description\": {}", quotedJson(meaning.description));
  if (!meaning.unit.empty()) json += fmt::format(", \"Units\": {}", quotedJson(meaning.unit));
  std::string levels;
  for (const auto& [value, means] : meaning.levels)
    levels += fmt::format("{}{}: {}", levels.empty() ? "" : ", ", quotedJson(value), quotedJson(means));
  return json + (levels.empty() ? "}" : fmt::format(", \"Levels\": {{{}}}}}", levels));
}

template <class Record>
std::string rowsOf(const std::vector<Record>& rows) {
  std::string text;
  const Record names{};
  forEachColumn(names, [&](const ColumnName& name, const auto&) { text += (text.empty() ? "" : "\t") + name.text(); });
  text += '\n';
  for (const Record& row : rows) {
    bool first = true;
    forEachColumn(row, [&](const ColumnName& name, const auto& field) {
      text += (first ? "" : "\t") + fieldOf(name, field);
      first = false;
    });
    text += '\n';
  }
  return text;
}

template <class Record>
std::string sidecarOf(const std::string& task, const ConditionLabels& conditions) {
  std::string json = fmt::format("{{\n  \"TaskName\": \"{}\"", bidsLabel(task));
  const Record names{};
  forEachColumn(names, [&](const ColumnName& name, const auto&) {
    json +=
        fmt::format(",\n  \"{}\": {}", name.text(), describedJson(meaningOf(tableName<Record>(), name, conditions)));
  });
  return json + "\n}\n";
}

// The files of one data set.
class DataSet {
 public:
  // `conditions` of the session, in the descriptions of columns that name one.
  DataSet(std::string directory, ConditionLabels conditions)
      : directory_(std::move(directory)), conditions_(std::move(conditions)) {
    makeDirectory(directory_);
  }

  void write(const std::string& path, const std::string& content) {
    writeAtomically(directory_ + "/" + path, content);
    paths.push_back(directory_ + "/" + path);
  }

  // A table per participant and task, with its sidecar. `taskOf` a row.
  template <class Record, class TaskOf>
  void writeTables(const std::vector<Record>& rows, const TaskOf& taskOf) {
    std::map<std::pair<std::int64_t, std::string>, std::vector<Record>> tables;
    for (const Record& row : rows) tables[{row.participant, taskOf(row)}].push_back(row);
    for (const auto& [key, own] : tables) {
      first_conditions_.try_emplace(key.first, own.front().condition);
      const std::string folder = subjectOf(key.first) + "/beh";
      const std::string stem = fmt::format("{}/{}_task-{}_beh", folder, subjectOf(key.first), bidsLabel(key.second));
      makeDirectory(directory_ + "/" + folder);
      write(stem + ".tsv", rowsOf(own));
      write(stem + ".json", sidecarOf<Record>(key.second, conditions_));
    }
  }

  // Where BIDS keeps questionnaires.
  void writeSurvey(const std::vector<SurveyRecord>& survey) {
    if (survey.empty()) return;
    makeDirectory(directory_ + "/phenotype");
    std::string rows = "participant_id\tmoment\titem\ttask\tcondition\tquestion\tanswer\tanswer_value\n";
    for (const SurveyRecord& r : survey) {
      rows += subjectOf(r.participant);
      for (const std::string* text : {&r.moment, &r.item, &r.task, &r.condition, &r.question, &r.answer})
        rows += "\t" + tsvText(*text);
      rows += "\t" + tsvField(r.answer_value) + "\n";
    }
    write("phenotype/survey.tsv", rows);
    std::string json =
        "{\n  \"MeasurementToolMetadata\": {\"Description\": \"questions of the study's file, asked by pincer\"}";
    const SurveyRecord names{};
    forEachColumn(names, [&](const ColumnName& name, const auto&) {
      if (name.quantity != "participant")
        json += fmt::format(",\n  \"{}\": {}", name.text(), describedJson(meaningOf("survey", name, conditions_)));
    });
    write("phenotype/survey.json", json + "\n}\n");
  }

  void writeParticipants() {
    std::string people = "participant_id\tfirst_condition\n";
    for (const auto& [person, condition] : first_conditions_)
      people += fmt::format("{}\t{}\n", subjectOf(person), tsvText(condition));
    write("participants.tsv", people);
    const ColumnMeaning meaning{"condition that the participant did first", "", conditions_};
    write("participants.json", fmt::format("{{\n  \"first_condition\": {}\n}}\n", describedJson(meaning)));
  }

  std::vector<std::string> paths;

 private:
  std::string directory_;
  ConditionLabels conditions_;
  std::map<std::int64_t, std::string> first_conditions_;
};

std::string descriptionOf(const SessionInfo& info) {
  return fmt::format(
      "{{\n  \"Name\": {},\n  \"BIDSVersion\": \"1.9.0\",\n  \"DatasetType\": \"raw\",\n"
      "  \"GeneratedBy\": [{{\"Name\": \"pincer\", \"Version\": {}}}]\n}}\n",
      quotedJson(fmt::format("{}, seed {}", info.task, info.seed)), quotedJson(info.version));
}

std::string readmeOf(const SessionReader& session) {
  const SessionInfo& info = session.info();
  return fmt::format(
      "# {}\n\nA session of pincer {}, seed {}, begun {}. One row per trial, in the order of doing. In a text, \\t, "
      "\\n, \\r and "
      "\\\\ stand for tab, line feed, carriage return and backslash; an apostrophe before = + - @ keeps spreadsheets "
      "from running "
      "it.\n\nDevices:\n\n```json\n{}\n```\n\n"
      "Protocol:\n\n```json\n{}\n```\n\nParticipants (of simulated ones every parameter):\n\n```json\n{}\n```\n",
      info.task, info.version, info.seed, session.startedUtc(), info.devices_json, info.protocol_json,
      info.participants_json);
}

}  // namespace

std::vector<std::string> exportBids(const SessionReader& session, const std::string& directory) {
  DataSet set(directory, conditionLabels(session.info()));
  set.write("dataset_description.json", descriptionOf(session.info()));
  set.write("README.md", readmeOf(session));
  set.writeTables(session.trials(), [](const TrialRecord& trial) { return trial.task; });
  set.writeTables(session.responses(), [&](const ResponseRecord&) { return session.info().task; });
  set.writeSurvey(session.survey());
  set.writeParticipants();
  return set.paths;
}

}  // namespace pincer::tasks
