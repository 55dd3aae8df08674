#include "pincer/tasks/lab/sweep/study_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/row_sink.h"
#include "pincer/tasks/lab/report/person_means.h"
#include "pincer/tasks/run/scene/json_change.h"

namespace pincer::tasks {
namespace {

ManipulationStudy studyAt(const std::string& task, const StudySweep& sweep, const std::vector<double>& point) {
  ManipulationStudy study;
  study.participants = sweep.participants;
  study.seed = sweep.seed;
  study.training = {0, 0};
  if (task == "sphere-pickup") study.tasks = {HandTask::kPickup};
  if (task == "cylinder-alignment") study.tasks = {HandTask::kAlignment};
  JsonValue json = parseJson(studyFile(study), task);
  for (std::size_t i = 0; i < point.size(); ++i) setNumber(json, sweep.variations[i].path, point[i]);
  return studyOfJson(json);
}

bool isMeasured(const std::string& task, const FindingMeasure& measure) {
  return task == "manipulation" || measure.of_pickup == (task == "sphere-pickup");
}

std::vector<double> meansOf(const std::string& task, const ManipulationStudy& study, const std::atomic<bool>& interrupted) {
  RowSink sink;
  runManipulationStudy(study, {}, sink, interrupted);
  std::vector<double> means;
  const std::vector<PairedRow> rows = pairedRows(sink.rows);
  for (std::size_t m = 0; m < findingMeasures().size(); ++m) {
    if (!isMeasured(task, findingMeasures()[m])) continue;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const PairedRow& r) { return r.measure == m; });
    for (const Estimate PairedRow::*condition : {&PairedRow::force, &PairedRow::cld}) {
      means.push_back(row == rows.end() ? std::numeric_limits<double>::quiet_NaN() : ((*row).*condition).mean);
    }
  }
  return means;
}

}  // namespace

bool isSweptStudy(const std::string& task) { return task == "sphere-pickup" || task == "cylinder-alignment" || task == "manipulation"; }

SweepTable sweepStudy(const std::string& task, const StudySweep& sweep, const SweepOptions& options, const std::atomic<bool>& interrupted) {
  constexpr std::size_t kMostRuns = 1000;
  SweepTable table;
  table.what = fmt::format("{}, {}", task, counted(sweep.participants, "participant"));
  table.points = gridOf(sweep.variations, kMostRuns);
  for (const Variation& variation : sweep.variations) table.parameters.push_back(variation.path);
  for (const std::vector<double>& point : table.points) studyAt(task, sweep, point);  // says what is wrong before anything runs
  for (const FindingMeasure& measure : findingMeasures()) {
    if (!isMeasured(task, measure)) continue;
    for (const char* condition : {"force only", "CLD + force"}) {
      table.measures.push_back(fmt::format("{}, {} [{}]", measure.label, condition, *measure.unit ? measure.unit : "-"));
      table.plotted.push_back(measure.expected != PublishedEffect::kNone);
    }
  }
  runSweep(table, options, interrupted, [&](std::size_t i) { return meansOf(task, studyAt(task, sweep, table.points[i]), interrupted); });
  return table;
}

}  // namespace pincer::tasks
