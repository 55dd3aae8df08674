#include "tasks/session/bids_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <type_traits>

#include "tasks/session/atomic_file.h"
#include "tasks/session/columns.h"

namespace pincer::tasks {
namespace {

// BIDS labels hold letters and digits only.
std::string bidsLabel(const std::string& text) {
  std::string label;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c))) label += c;
  }
  return label;
}

std::string subjectOf(std::int64_t participant) { return fmt::format("sub-{:02}", participant + 1); }

template <class Field>
std::string tsvField(const Field& field) {
  if constexpr (std::is_floating_point_v<Field>) {
    return field != field ? "n/a" : fmt::format("{}", field);
  } else if constexpr (std::is_same_v<Field, std::string>) {
    std::string text = field.empty() ? "n/a" : field;
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text;
  } else {
    return fmt::format("{}", field);
  }
}

std::string trialsTsv(const std::vector<TrialRecord>& trials) {
  std::string text;
  const TrialRecord names{};
  forEachColumn(names, [&](const ColumnName& name, const auto&) { text += (text.empty() ? "" : "\t") + name.text(); });
  text += '\n';
  for (const TrialRecord& trial : trials) {
    bool first = true;
    forEachColumn(trial, [&](const ColumnName&, const auto& field) {
      text += (first ? "" : "\t") + tsvField(field);
      first = false;
    });
    text += '\n';
  }
  return text;
}

std::string trialsSidecar(const std::string& task) {
  std::string json = fmt::format("{{\n  \"TaskName\": \"{}\"", bidsLabel(task));
  const TrialRecord names{};
  forEachColumn(names, [&](const ColumnName& name, const auto&) {
    json += fmt::format(",\n  \"{}\": {{\"Description\": \"{}\"", name.text(), name.quantity);
    json += name.unit.empty() ? std::string("}") : fmt::format(", \"Units\": \"{}\"}}", name.unit);
  });
  return json + "\n}\n";
}

}  // namespace

std::vector<std::string> exportBids(const SessionReader& session, const std::string& directory) {
  std::map<std::pair<std::int64_t, std::string>, std::vector<TrialRecord>> files;
  for (const TrialRecord& trial : session.trials()) files[{trial.participant, trial.task}].push_back(trial);
  std::vector<std::string> paths;
  const auto write = [&](const std::string& path, const std::string& content) {
    writeAtomically(path, content);
    paths.push_back(path);
  };
  makeDirectory(directory);
  write(directory + "/dataset_description.json",
        fmt::format("{{\n  \"Name\": \"{}, seed {}\",\n  \"BIDSVersion\": \"1.9.0\",\n  \"DatasetType\": \"raw\",\n"
                    "  \"GeneratedBy\": [{{\"Name\": \"pincer\", \"Version\": \"{}\"}}]\n}}\n",
                    session.info().task, session.info().seed, session.info().version));
  std::string people = "participant_id\tfirst_condition\n";
  std::int64_t last = -1;
  for (const auto& [key, trials] : files) {
    if (key.first != last) people += fmt::format("{}\t{}\n", subjectOf(key.first), trials.front().condition);
    last = key.first;
  }
  write(directory + "/participants.tsv", people);
  write(directory + "/participants.json", "{\n  \"first_condition\": {\"Description\": \"condition that the participant did first\"}\n}\n");
  for (const auto& [key, trials] : files) {
    const std::string folder = directory + "/" + subjectOf(key.first) + "/beh";
    const std::string stem = fmt::format("{}/{}_task-{}_beh", folder, subjectOf(key.first), bidsLabel(key.second));
    makeDirectory(folder);
    write(stem + ".tsv", trialsTsv(trials));
    write(stem + ".json", trialsSidecar(key.second));
  }
  return paths;
}

}  // namespace pincer::tasks
