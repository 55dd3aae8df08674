#include "pincer/tasks/lab/sessions/study_runs.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/findings/claims.h"
#include "pincer/tasks/lab/findings/findings.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/sessions/session_runs.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"

namespace pincer::tasks {
namespace {

constexpr int kNoSamples = std::numeric_limits<int>::max();  // hours of strokes: the answers are what counts

enum class Control : std::uint8_t { kNone, kParked, kUnrelated };

constexpr const char* nameOf(Control control) {
  return control == Control::kNone ? "" : control == Control::kParked ? "-frozen" : "-unrelated";
}

template <class Study>
constexpr bool has(Control control) {
  if (control == Control::kParked) return requires(Study s) {
      s.frozen_tactor;
    };
  if (control == Control::kUnrelated) return requires(Study s) {
      s.unrelated;
    };
  return true;
}

template <class Study>
void put(Control control, Study& study) {
  if constexpr (requires { study.frozen_tactor; }) study.frozen_tactor = control == Control::kParked;
  if constexpr (requires { study.unrelated; }) study.unrelated = control == Control::kUnrelated;
}

std::string pathOf(const StudyRuns& runs, const std::string& task, int experiment, Control control) {
  return fmt::format("{}/{}{}-{}.db", runs.directory, task, nameOf(control), experiment);
}

template <class Experiment, class Study>
SessionRun runOfExperiment(const std::string& task, Study study, const StudyRuns& runs, int experiment, Control control,
                           const std::atomic<bool>& interrupted) {
  if (runs.participants > 0) study.participants = runs.participants;
  study.seed = seedFor(runs.seed, static_cast<std::uint64_t>(experiment)) >> 1;
  put(control, study);
  validate(study);
  StudySession session;
  session.path = pathOf(runs, task, experiment, control);
  session.info = studySessionInfo(task, study.seed, studyJson(study), participantsJson(study), {}, 0);
  session.info.scene_json = claimsJson(claimsHash());
  return {session.path, session.info, [=, &interrupted](bool resume, const ShareDone& share) {
            StudySession now = session;
            now.resume = resume;
            Experiment presented(study, {}, kNoSamples);
            runStudySession(presented, now, interrupted, [&](const StudyProgress& p) { share(p.share); });
          }};
}

struct PublishedStudy {
  std::string task;
  std::function<bool(Control)> has;
  std::function<SessionRun(const StudyRuns& runs, int experiment, Control control,
                           const std::atomic<bool>& interrupted)>
      experiment;
};

template <class Experiment, class Study>
PublishedStudy publishedStudy(const std::string& task, const Study& study) {
  return {task, has<Study>,
          [=](const StudyRuns& runs, int experiment, Control control, const std::atomic<bool>& interrupted) {
            return runOfExperiment<Experiment>(task, study, runs, experiment, control, interrupted);
          }};
}

std::vector<PublishedStudy> publishedStudies(const std::string& only) {
  std::vector<PublishedStudy> studies;
  for (PublishedStudy& study : std::vector<PublishedStudy>{
           publishedStudy<LocalisationExperiment>("repeated-localisation", LocalisationStudy{}),
           publishedStudy<ArcExperiment>("smoothness-discrimination", smoothnessStudy()),
           publishedStudy<ArcExperiment>("backlash-discrimination", backlashStudy()),
           publishedStudy<ArcExperiment>("delay-discrimination", delayStudy()),
           publishedStudy<ShapeExperiment>("shape-identification", ShapeStudy{}),
       }) {
    if (isWanted(study.task, only)) studies.push_back(std::move(study));
  }
  return studies;
}

// The part's own share of `count` experiments of each.
void addRuns(const std::vector<PublishedStudy>& studies, const StudyRuns& runs, int count, Control control,
             const std::atomic<bool>& interrupted, std::vector<SessionRun>& sessions) {
  for (int e = runs.part - 1; e < count; e += runs.parts) {
    for (const PublishedStudy& study : studies) {
      if (study.has(control)) sessions.push_back(study.experiment(runs, e, control, interrupted));
    }
  }
}

std::map<std::string, std::vector<std::string>> filesOf(const std::vector<PublishedStudy>& studies,
                                                        const StudyRuns& runs, int count, Control control) {
  std::map<std::string, std::vector<std::string>> found;
  for (const PublishedStudy& study : studies) {
    for (int e = 0; e < count; ++e) {
      const std::string path = pathOf(runs, study.task, e, control);
      if (std::filesystem::exists(path)) found[study.task].push_back(path);
    }
  }
  return found;
}

}  // namespace

StudySessions runPublishedStudies(const StudyRuns& runs, const std::atomic<bool>& interrupted,
                                  const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::vector<PublishedStudy> studies = publishedStudies(runs.only);
  if (studies.empty() || runs.experiments + runs.controls == 0) return {};
  makeDirectory(runs.directory);
  std::vector<SessionRun> sessions;
  addRuns(studies, runs, runs.experiments, Control::kNone, interrupted, sessions);
  addRuns(studies, runs, runs.controls, Control::kParked, interrupted, sessions);
  addRuns(studies, runs, runs.controls, Control::kUnrelated, interrupted, sessions);
  runSessions(sessions, runs.threads, interrupted, progress);
  return {filesOf(studies, runs, runs.experiments, Control::kNone),
          filesOf(studies, runs, runs.controls, Control::kParked),
          filesOf(studies, runs, runs.controls, Control::kUnrelated)};
}

}  // namespace pincer::tasks
