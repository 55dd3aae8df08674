#include "tasks/app/study_runs.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <mutex>
#include <thread>

#include "contact/error.h"
#include "tasks/app/study_file.h"
#include "tasks/app/study_session.h"
#include "tasks/findings/findings.h"
#include "tasks/participants/random.h"
#include "tasks/session/atomic_file.h"

namespace pincer::tasks {
namespace {

constexpr int kNoSamples = std::numeric_limits<int>::max();  // hours of strokes: the answers are what counts

// A session that is there must be of this study; whether it is complete.
bool isComplete(const StudySession& session) {
  const SessionReader reader(session.path);
  const bool same = reader.info().protocol_json == session.info.protocol_json &&
                    reader.info().participants_json == session.info.participants_json && reader.info().seed == session.info.seed;
  if (!same)
    throw InputError(session.path + ": is of another design, seed or of other participants than would be run now. Give another --out.");
  return reader.complete();
}

// Of share 0 .. 1.
using ShareDone = std::function<void(double share)>;

template <class MakeExperiment, class Study>
void runExperiment(const std::string& task, Study study, const StudyRuns& runs, int experiment, const std::string& path,
                   const MakeExperiment& make, const std::atomic<bool>& interrupted, const ShareDone& done) {
  study.participants = runs.participants;
  study.seed = seedFor(runs.seed, static_cast<std::uint64_t>(experiment)) >> 1;
  validate(study);
  StudySession session;
  session.path = path;
  session.info = studySessionInfo(task, study.seed, studyJson(study), participantsJson(study), {}, 0);
  session.resume = std::filesystem::exists(path);
  if (session.resume && isComplete(session)) return done(1);
  auto presented = make(study);
  runStudySession(presented, session, interrupted, [&](const StudyProgress& p) { done(p.share); });
}

struct PublishedStudy {
  std::string task;
  std::function<void(const StudyRuns& runs, int experiment, const std::string& path, const std::atomic<bool>& interrupted,
                     const ShareDone& done)>
      run;
};

template <class Experiment, class Study>
PublishedStudy publishedStudy(const std::string& task, const Study& study) {
  return {task,
          [=](const StudyRuns& runs, int experiment, const std::string& path, const std::atomic<bool>& interrupted, const ShareDone& done) {
            const auto make = [](const Study& s) { return Experiment(s, {}, kNoSamples); };
            runExperiment(task, study, runs, experiment, path, make, interrupted, done);
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

// The experiments of all studies, the first of each first, shared among threads.
class StudyWorkshop {
 public:
  StudyWorkshop(const StudyRuns& runs, const std::vector<PublishedStudy>& studies, const std::atomic<bool>& interrupted,
                const std::function<void(std::int64_t, std::int64_t)>& progress)
      : runs_(runs),
        studies_(studies),
        interrupted_(interrupted),
        progress_(progress),
        shares_(studies.size() * static_cast<std::size_t>(runs.experiments)) {}

  void run() {
    std::vector<std::thread> threads;
    for (int t = 0; t < runs_.threads; ++t) threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
  }
  std::string pathOf(std::size_t study, std::size_t experiment) const {
    return fmt::format("{}/{}-{}.db", runs_.directory, studies_[study].task, experiment);
  }

 private:
  void work() {
    try {
      for (std::size_t job = next_++; job < shares_.size() && !interrupted_; job = next_++) {
        const std::size_t study = job % studies_.size(), experiment = job / studies_.size();
        studies_[study].run(runs_, static_cast<int>(experiment), pathOf(study, experiment), interrupted_,
                            [&](double share) { note(job, share); });
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      next_ = shares_.size();
    }
  }
  void note(std::size_t job, double share) {
    const std::lock_guard lock(mutex_);
    sum_ += share - shares_[job];
    shares_[job] = share;
    if (progress_) progress_(std::lround(1000 * sum_), 1000 * static_cast<std::int64_t>(shares_.size()));
  }

  const StudyRuns& runs_;
  const std::vector<PublishedStudy>& studies_;
  const std::atomic<bool>& interrupted_;
  const std::function<void(std::int64_t, std::int64_t)>& progress_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;  // guards the rest
  std::vector<double> shares_;
  double sum_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<StudySessions> runPublishedStudies(const StudyRuns& runs, const std::atomic<bool>& interrupted,
                                               const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const std::vector<PublishedStudy> studies = publishedStudies(runs.only);
  if (studies.empty() || runs.experiments == 0) return {};
  makeDirectory(runs.directory);
  StudyWorkshop workshop(runs, studies, interrupted, progress);
  workshop.run();
  std::vector<StudySessions> sessions;
  for (std::size_t s = 0; s < studies.size(); ++s) {
    sessions.push_back({studies[s].task, {}});
    for (std::size_t e = 0; e < static_cast<std::size_t>(runs.experiments); ++e) {
      if (std::filesystem::exists(workshop.pathOf(s, e))) sessions.back().paths.push_back(workshop.pathOf(s, e));
    }
  }
  return sessions;
}

}  // namespace pincer::tasks
