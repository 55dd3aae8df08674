#include "pincer/tasks/lab/experiments/study.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kPeople = 1, kTrials = 2;  // parts of the seed

// What a run shows next.
class RunProgress {
 public:
  explicit RunProgress(const StudyRun& run) : run_(run) {
    if (run.staircase) staircase_.emplace(*run.staircase);
  }
  bool over() const { return staircase_ ? staircase_->over() : index_ >= run_.list.size(); }
  double share() const { return staircase_ ? staircase_->progress() : static_cast<double>(index_) / static_cast<double>(run_.list.size()); }
  ListedStimulus next() const { return staircase_ ? ListedStimulus{"", staircase_->level()} : run_.list[index_]; }
  // Returns whether the staircase turned.
  bool take(const ResponseRecord& response) {
    ++index_;
    return staircase_ && staircase_->answer(response.correct == 1);
  }
  std::int64_t index() const { return static_cast<std::int64_t>(index_); }

 private:
  const StudyRun& run_;
  std::optional<Staircase> staircase_;
  std::size_t index_ = 0;
};

const std::string& conditionOf(const StudyTrial& trial) {
  return trial.run->condition.empty() ? trial.stimulus.condition : trial.run->condition;
}

void requireSameTrial(const ResponseRecord& earlier, const StudyTrial& trial) {
  const StudyRun& run = *trial.run;
  const std::string& condition = conditionOf(trial);
  if (earlier.trial == trial.trial && earlier.participant == run.participant && earlier.run == run.run && earlier.index == trial.index &&
      earlier.condition == condition && earlier.stimulus == trial.stimulus.name &&
      (earlier.level == trial.stimulus.level || earlier.level != earlier.level))
    return;
  throw InputError(
      fmt::format("trial {} of the session isn't the one that this study would show: participant {}, {}, level {}. Resume with "
                  "the parameters and the seed of the session.",
                  trial.trial, earlier.participant, earlier.condition, earlier.level));
}

class StudyRunner {
 public:
  StudyRunner(Experiment& experiment, std::uint64_t seed, const std::vector<ResponseRecord>& earlier, StudySink& sink,
              const std::atomic<bool>& interrupted)
      : experiment_(experiment), seed_(seed), earlier_(earlier), sink_(sink), interrupted_(interrupted), runs_(experiment.runs()) {}

  StudyOutcome run(const std::function<void(const StudyProgress&)>& progress) {
    for (std::size_t k = 0; k < runs_.size() && !outcome_.interrupted; ++k) {
      RunProgress state(runs_[k]);
      while (!state.over() && !outcome_.interrupted) {
        runTrial(runs_[k], state);
        if (progress) progress({(static_cast<double>(k) + state.share()) / static_cast<double>(runs_.size())});
      }
    }
    return outcome_;
  }

 private:
  void runTrial(const StudyRun& run, RunProgress& state) {
    StudyTrial trial{outcome_.trials, state.index(), &run, state.next(), 0, 0};
    trial.person_seed = seedFor(seedFor(seed_, kPeople), static_cast<std::uint64_t>(run.participant));
    trial.seed = seedFor(seedFor(seed_, kTrials), static_cast<std::uint64_t>(trial.trial));
    const auto done = static_cast<std::size_t>(outcome_.trials);
    if (done < earlier_.size()) {
      requireSameTrial(earlier_[done], trial);
      state.take(earlier_[done]);
      ++outcome_.trials;
      return;
    }
    auto response = experiment_.present(trial, sink_, interrupted_, outcome_.servo);
    outcome_.interrupted = !response;
    if (!response) return;
    response->trial = trial.trial;
    response->participant = run.participant;
    response->run = run.run;
    response->index = trial.index;
    response->condition = conditionOf(trial);
    response->reversal = state.take(*response);
    sink_.response(*response);
    ++outcome_.trials;
  }

  Experiment& experiment_;
  std::uint64_t seed_;
  const std::vector<ResponseRecord>& earlier_;
  StudySink& sink_;
  const std::atomic<bool>& interrupted_;
  std::vector<StudyRun> runs_;
  StudyOutcome outcome_;
};

}  // namespace

StudyOutcome runStudy(Experiment& experiment, std::uint64_t seed, const std::vector<ResponseRecord>& earlier, StudySink& sink,
                      const std::atomic<bool>& interrupted, const std::function<void(const StudyProgress&)>& progress) {
  StudyOutcome outcome = StudyRunner(experiment, seed, earlier, sink, interrupted).run(progress);
  return outcome;
}

}  // namespace pincer::tasks
