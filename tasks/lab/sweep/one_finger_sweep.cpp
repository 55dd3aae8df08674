#include "pincer/tasks/lab/sweep/one_finger_sweep.h"

#include <fmt/format.h>

#include <limits>

#include "pincer/contact/io/counted.h"
#include "pincer/tasks/lab/experiments/arc_study.h"
#include "pincer/tasks/lab/experiments/localisation.h"
#include "pincer/tasks/lab/experiments/shape_study.h"
#include "pincer/tasks/lab/experiments/study_reader.h"
#include "pincer/tasks/lab/experiments/study_writer.h"
#include "pincer/tasks/lab/report/study_summary.h"
#include "pincer/tasks/lab/sweep/sweep_parts.h"
#include "pincer/tasks/run/scene/json_change.h"

namespace pincer::tasks {
namespace {

constexpr int kKeepsNothing = std::numeric_limits<int>::max();  // ticks between two kept samples: no trial is as long

class ResponseSink final : public StudySink {
 public:
  void sample(const SampleRecord&) override {}
  void event(const EventRecord&) override {}
  void response(const ResponseRecord& response) override { responses.push_back(response); }
  std::vector<ResponseRecord> responses;
};

template <class Experiment, class Study>
class OneFingerSweep {
 public:
  OneFingerSweep(Study published, const std::string& task, const StudySweep& sweep)
      : published_(std::move(published)), task_(task), sweep_(sweep) {
    published_.participants = sweep.participants;
    published_.seed = sweep.seed;
  }

  SweepTable table() const {
    SweepTable table = tableOf(fmt::format("{}, {}", task_, counted(sweep_.participants, "participant")), sweep_.grid);
    refuseUnreadable(table, [&](const std::vector<double>& point) { studyAt(point); });
    const StudySummary nobody = summaryOf(published_, asked());
    for (const StudyCondition& condition : nobody.conditions) {
      addMeasure(table, fmt::format("{}, {} [{}]", nobody.headline.name, condition.name, nobody.headline.unit), true);
    }
    return table;
  }

  CaseResult caseAt(std::size_t i, const std::atomic<bool>& interrupted) const {
    return {true, headlinesAt(sweep_.grid.points[i], interrupted), "", ""};
  }

 private:
  Study studyAt(const std::vector<double>& point) const {
    JsonValue json = parseJson(studyText(published_), task_);
    for (std::size_t i = 0; i < point.size(); ++i) setNumber(json, sweep_.grid.paths[i], point[i]);
    Study study = published_;
    readStudyText(json, study);
    return study;
  }

  // The study as it would be asked, for the names of the conditions alone: not every study's file lists them.
  std::vector<ResponseRecord> asked() const {
    std::vector<ResponseRecord> responses(1);
    for (const StudyRun& run : Experiment(published_, {}, kKeepsNothing).runs()) {
      responses.back().condition =
          run.condition.empty() && !run.list.empty() ? run.list.front().condition : run.condition;
    }
    return responses;
  }

  StudySummary summaryOf(const Study& study, const std::vector<ResponseRecord>& responses) const {
    SessionInfo info;
    info.task = task_;
    info.protocol_json = studyText(study);
    return summariseStudy(info, task_, responses);
  }

  std::vector<double> headlinesAt(const std::vector<double>& point, const std::atomic<bool>& interrupted) const {
    const Study study = studyAt(point);
    Experiment experiment(study, {}, kKeepsNothing);
    ResponseSink sink;
    runStudy(experiment, study.seed, {}, sink, interrupted);
    const StudySummary summary = summaryOf(study, sink.responses);
    std::vector<double> headlines;
    for (const StudyCondition& c : summary.conditions) {
      headlines.push_back(isUnsettled(c) ? std::numeric_limits<double>::quiet_NaN()
                                         : summary.headline.scale * c.headline.mean);
    }
    return headlines;
  }

  Study published_;
  std::string task_;
  StudySweep sweep_;
};

template <class Experiment, class Study>
SweepJob jobOf(const Study& published, const std::string& task, const StudySweep& sweep) {
  const OneFingerSweep<Experiment, Study> cases(published, task, sweep);
  SweepJob job;
  job.table = cases.table();
  job.definition = studyDefinition(job.table, task, sweep.participants, sweep.seed);
  job.measure = [cases](std::size_t i, const std::atomic<bool>& interrupted) { return cases.caseAt(i, interrupted); };
  return job;
}

}  // namespace

SweepJob oneFingerSweep(const std::string& task, const StudySweep& sweep) {
  if (task == "repeated-localisation") return jobOf<LocalisationExperiment>(LocalisationStudy{}, task, sweep);
  if (task == "shape-identification") return jobOf<ShapeExperiment>(ShapeStudy{}, task, sweep);
  for (const ArcStudy& study : {smoothnessStudy(), backlashStudy(), delayStudy()}) {
    if (task == study.task) return jobOf<ArcExperiment>(study, task, sweep);
  }
  throw InputError(fmt::format("{}: isn't a study with one finger.", task));
}

}  // namespace pincer::tasks
