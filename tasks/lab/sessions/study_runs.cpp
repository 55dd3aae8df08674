#include "pincer/tasks/lab/sessions/study_runs.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "pincer/contact/io/atomic_file.h"
#include "pincer/tasks/lab/findings/findings.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/sessions/session_runs.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/lab/sessions/study_session.h"

namespace pincer::tasks {
namespace {

constexpr int kNoSamples = std::numeric_limits<int>::max();  // hours of strokes: the answers are what counts

template <class MakeExperiment, class Study>
SessionRun runOfExperiment(const std::string& task, Study study, const StudyRuns& runs, int experiment, const MakeExperiment& make,
                           const std::atomic<bool>& interrupted) {
  study.participants = runs.participants;
  study.seed = seedFor(runs.seed, static_cast<std::uint64_t>(experiment)) >> 1;
  validate(study);
  StudySession session;
  session.path = fmt::format("{}/{}-{}.db", runs.directory, task, experiment);
  session.info = studySessionInfo(task, study.seed, studyJson(study), participantsJson(study), {}, 0);
  return {session.path, session.info, [=, &interrupted](bool resume, const ShareDone& share) {
            StudySession now = session;
            now.resume = resume;
            auto presented = make(study);
            runStudySession(presented, now, interrupted, [&](const StudyProgress& p) { share(p.share); });
          }};
}

struct PublishedStudy {
  std::string task;
  std::function<SessionRun(const StudyRuns& runs, int experiment, const std::atomic<bool>& interrupted)> experiment;
};

template <class Experiment, class Study>
PublishedStudy publishedStudy(const std::string& task, const Study& study) {
  return {task, [=](const StudyRuns& runs, int experiment, const std::atomic<bool>& interrupted) {
            const auto make = [](const Study& s) { return Experiment(s, {}, kNoSamples); };
            return runOfExperiment(task, study, runs, experiment, make, interrupted);
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

}  // namespace

std::vector<StudySessions> runPublishedStudies(const StudyRuns& runs, const std::atomic<bool>& interrupted,
                                               const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::vector<PublishedStudy> studies = publishedStudies(runs.only);
  if (studies.empty() || runs.experiments == 0) return {};
  makeDirectory(runs.directory);
  std::vector<SessionRun> sessions;
  for (int e = 0; e < runs.experiments; ++e) {
    for (const PublishedStudy& study : studies) sessions.push_back(study.experiment(runs, e, interrupted));
  }
  runSessions(sessions, runs.threads, interrupted, progress);
  std::vector<StudySessions> found;
  for (const PublishedStudy& study : studies) found.push_back({study.task, {}});
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    if (std::filesystem::exists(sessions[k].path)) found[k % studies.size()].paths.push_back(sessions[k].path);
  }
  return found;
}

}  // namespace pincer::tasks
