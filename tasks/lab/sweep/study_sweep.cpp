#include "pincer/tasks/lab/sweep/study_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/experiments/row_sink.h"
#include "pincer/tasks/lab/report/person_means.h"
#include "pincer/tasks/lab/sweep/sweep_parts.h"
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
  for (std::size_t i = 0; i < point.size(); ++i) setNumber(json, sweep.grid.paths[i], point[i]);
  return studyOfJson(json);
}

std::vector<std::string> namesOf(const ManipulationStudy& study) {
  std::vector<std::string> names;
  for (const HandCondition& condition : study.conditions) names.push_back(condition.name);
  return names;
}

bool isMeasured(const std::string& task, const FindingMeasure& measure) {
  return task == "manipulation" || measure.of_pickup == (task == "sphere-pickup");
}

std::vector<double> meansOf(const std::string& task, const ManipulationStudy& study,
                            const std::atomic<bool>& interrupted) {
  RowSink sink;
  runManipulationStudy(study, {}, sink, interrupted);
  std::vector<double> means;
  const std::vector<MeasureRow> rows = measureRows(sink.rows, namesOf(study));
  for (std::size_t m = 0; m < findingMeasures().size(); ++m) {
    if (!isMeasured(task, findingMeasures()[m])) continue;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const MeasureRow& r) { return r.measure == m; });
    for (std::size_t c = 0; c < study.conditions.size(); ++c)
      means.push_back(row == rows.end() ? std::numeric_limits<double>::quiet_NaN() : row->means[c].mean);
  }
  return means;
}

}  // namespace

bool isSweptStudy(const std::string& task) {
  return task == "sphere-pickup" || task == "cylinder-alignment" || task == "manipulation";
}

SweepJob studySweep(const std::string& task, const StudySweep& sweep) {
  SweepJob job;
  job.table = tableOf(fmt::format("{}, {}", task, counted(sweep.participants, "participant")), sweep.grid);
  for (const FindingMeasure& measure : findingMeasures()) {
    if (!isMeasured(task, measure)) continue;
    for (const HandCondition& condition : ManipulationStudy{}.conditions) {
      const std::string label =
          fmt::format("{}, {} [{}]", measure.label, condition.label, *measure.unit ? measure.unit : "-");
      addMeasure(job.table, label, measure.expected != PublishedEffect::kNone);
    }
  }
  refuseUnreadable(job.table, [&](const std::vector<double>& point) { studyAt(task, sweep, point); });
  job.definition = studyDefinition(job.table, task, sweep.participants, sweep.seed);
  job.measure = [task, sweep](std::size_t i, const std::atomic<bool>& interrupted) {
    return CaseResult{true, meansOf(task, studyAt(task, sweep, sweep.grid.points[i]), interrupted), "", ""};
  };
  return job;
}

}  // namespace pincer::tasks
