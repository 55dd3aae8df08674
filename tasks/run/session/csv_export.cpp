#include "pincer/tasks/run/session/csv_export.h"

#include <type_traits>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/run/csv.h"
#include "pincer/tasks/run/session/column_meanings.h"

namespace pincer::tasks {

namespace {

template <class Record>
void addNames(CsvTable& table) {
  const Record record{};
  forEachColumn(record, [&](const ColumnName& name, const auto&) { table.add(name.text()); });
}

template <class Record>
void addValues(CsvTable& table, const Record& record) {
  forEachColumn(record, [&]<class Field>(const ColumnName& name, const Field& field) {
    if constexpr (std::is_same_v<Field, std::int64_t>) {
      table.add(field + countsFrom(name));
    } else {
      table.add(field);
    }
  });
}

template <class Record>
std::string asCsv(const std::vector<Record>& records) {
  CsvTable table;
  addNames<Record>(table);
  table.endRow();
  for (const Record& record : records) {
    addValues(table, record);
    table.endRow();
  }
  return table.take();
}

std::string sessionCsv(const SessionReader& session) {
  CsvTable table;
  addNames<SessionInfo>(table);
  addNames<SessionProgress>(table);
  table.endRow();
  addValues(table, session.info());
  addValues(table, session.progress());
  table.endRow();
  return table.take();
}

// Streamed: a session of an hour holds millions of samples.
void writeSamples(const SessionReader& session, const SampleFilter& filter, const std::string& path) {
  AtomicFile file(path);
  CsvTable table;
  addNames<SampleRecord>(table);
  table.endRow();
  session.forEachSample(filter, [&](const SampleRecord& sample) {
    addValues(table, sample);
    table.endRow();
    file.write(table.take());
  });
  file.write(table.take());
  file.commit();
}

// Likewise.
void writeInputs(const SessionReader& session, const std::string& path) {
  AtomicFile file(path);
  CsvTable table;
  addNames<InputRecord>(table);
  table.endRow();
  for (const HandsRecord& hands : session.hands()) {
    session.forEachInput(hands.trial, [&](const InputRecord& input) {
      addValues(table, input);
      table.endRow();
      file.write(table.take());
    });
  }
  file.write(table.take());
  file.commit();
}

}  // namespace

std::vector<std::string> exportCsv(const SessionReader& session, const std::string& directory,
                                   const SampleFilter& filter) {
  makeDirectory(directory);
  std::vector<std::string> paths{directory + "/session.csv", directory + "/trial.csv",    directory + "/sample.csv",
                                 directory + "/event.csv",   directory + "/response.csv", directory + "/reading.csv"};
  writeAtomically(paths[0], sessionCsv(session));
  writeAtomically(paths[1], asCsv(session.trials()));
  writeSamples(session, filter, paths[2]);
  writeAtomically(paths[3], asCsv(session.events()));
  writeAtomically(paths[4], asCsv(session.responses()));
  writeAtomically(paths[5], asCsv(session.readings()));
  paths.push_back(directory + "/columns.csv");
  writeAtomically(paths.back(), columnsCsv(conditionLabels(session.info())));
  if (const auto survey = session.survey(); !survey.empty()) {
    paths.push_back(directory + "/survey.csv");
    writeAtomically(paths.back(), asCsv(survey));
  }
  if (session.hands().empty()) return paths;
  paths.push_back(directory + "/hands.csv");
  writeAtomically(paths.back(), asCsv(session.hands()));
  paths.push_back(directory + "/input.csv");
  writeInputs(session, paths.back());
  return paths;
}

}  // namespace pincer::tasks
