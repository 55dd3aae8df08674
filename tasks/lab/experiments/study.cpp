#include "pincer/tasks/lab/experiments/study.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/finger/simulated_finger.h"
#include "pincer/tasks/lab/participants/random.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kPeople = 1, kTrials = 2, kTraining = 3, kOrders = 4;  // parts of the seed

// The next stimulus of a run.
class RunProgress {
 public:
  explicit RunProgress(const StudyRun& run) : run_(run) {
    if (run.staircase) staircase_.emplace(*run.staircase);
  }
  bool over() const { return staircase_ ? staircase_->over() : index_ >= run_.list.size(); }
  double share() const {
    return staircase_ ? staircase_->progress() : static_cast<double>(index_) / static_cast<double>(run_.list.size());
  }
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
  if (earlier.trial == trial.trial && earlier.participant == run.participant && earlier.run == run.run &&
      earlier.index == trial.index && earlier.condition == condition && earlier.stimulus == trial.stimulus.name &&
      (earlier.level == trial.stimulus.level || earlier.level != earlier.level))
    return;
  throw InputError(fmt::format(
      "trial {} of the session isn't the one that this study would show: participant {}, {}, level {}. Resume with "
      "the parameters and the seed of the session.",
      trial.trial + 1, earlier.participant + 1, earlier.condition, earlier.level));
}

// Keeps nothing: of trials of training.
struct NoSink final : StudySink {
  bool wantsSample(std::int64_t) const override { return false; }
  void sample(const SampleRecord&) override {}
  void event(const EventRecord&) override {}
  void response(const ResponseRecord&) override {}
};

class StudyRunner {
 public:
  StudyRunner(Experiment& experiment, std::uint64_t seed, const std::vector<ResponseRecord>& earlier, StudySink& sink,
              const std::atomic<bool>& interrupted)
      : experiment_(experiment),
        seed_(seed),
        earlier_(earlier),
        sink_(sink),
        interrupted_(interrupted),
        runs_(experiment.runs()) {
    if (const auto person = experiment.host().person)
      std::erase_if(runs_, [&](const StudyRun& run) { return run.participant != *person; });
  }

  StudyOutcome run(const std::function<void(const StudyProgress&)>& progress) {
    const FingerHost& host = experiment_.host();
    outcome_.interrupted = host.arm && !host.arm("The session begins.");
    for (std::size_t k = 0; k < runs_.size() && !outcome_.interrupted; ++k) {
      RunProgress state(runs_[k]);
      introduced_ = false;
      while (!state.over() && !outcome_.interrupted) {
        runTrial(runs_[k], state);
        if (progress) progress({(static_cast<double>(k) + state.share()) / static_cast<double>(runs_.size())});
      }
    }
    return outcome_;
  }

 private:
  StudyTrial trialOf(const StudyRun& run, std::int64_t index, const ListedStimulus& stimulus,
                     std::uint64_t part) const {
    StudyTrial trial{outcome_.trials, index, &run, stimulus, 0, 0};
    trial.person_seed = seedFor(seedFor(seed_, kPeople), static_cast<std::uint64_t>(run.participant));
    trial.seed = seedFor(seedFor(seed_, part), static_cast<std::uint64_t>(trial.trial));
    return trial;
  }

  void runTrial(const StudyRun& run, RunProgress& state) {
    const StudyTrial trial = trialOf(run, state.index(), state.next(), kTrials);
    const auto done = static_cast<std::size_t>(outcome_.trials);
    if (done < earlier_.size()) {
      requireSameTrial(earlier_[done], trial);
      state.take(earlier_[done]);
      ++outcome_.trials;
      return;
    }
    if (!introduced_) introduce(run, state.index() > 0);
    if (outcome_.interrupted) return;
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

  // Of a run that is gone on with, only the page.
  void introduce(const StudyRun& run, bool goes_on) {
    introduced_ = true;
    const FingerHost& host = experiment_.host();
    if (!host.show) return;
    StudyPage page = experiment_.introduction(run);
    if (!experiment_.plan().instructions.empty()) page.lines = experiment_.plan().instructions;
    const bool trains = !goes_on && experiment_.plan().training > 0;
    if (trains) page.lines.push_back("First you train: the object and your finger are shown. Nothing of it is kept.");
    if (goes_on || outcome_.trials > 0) page.lines.push_back("Rest as long as you like before you go on.");
    outcome_.interrupted = !host.show(page);
    if (trains && !outcome_.interrupted) train(run);
  }

  void train(const StudyRun& run) {
    NoSink nothing;
    const std::vector<ListedStimulus> stimuli = experiment_.training(run);
    for (std::int64_t index = 0; index < experiment_.plan().training; ++index) {
      StudyTrial trial = trialOf(run, index, stimuli[static_cast<std::size_t>(index) % stimuli.size()], kTraining);
      trial.training = true;
      const auto response = experiment_.present(trial, nothing, interrupted_, outcome_.servo);
      outcome_.interrupted = !response || !experiment_.host().show({"Training", {experiment_.feedback(*response)}});
      if (outcome_.interrupted) return;
    }
    outcome_.interrupted =
        !experiment_.host().show({"The trials begin", {"From now on nothing is shown. There is no time limit."}});
  }

  Experiment& experiment_;
  std::uint64_t seed_;
  const std::vector<ResponseRecord>& earlier_;
  StudySink& sink_;
  const std::atomic<bool>& interrupted_;
  std::vector<StudyRun> runs_;
  StudyOutcome outcome_;
  bool introduced_ = false;  // the run that goes on
};

}  // namespace

Order conditionOrder(ConditionOrder order, std::size_t count, std::int64_t participant, int block, std::uint64_t seed) {
  if (count == 0) return {};
  const auto rows = reducedLatinSquare(static_cast<int>(count));
  if (order == ConditionOrder::kBalanced) return rows[static_cast<std::size_t>(participant + block) % rows.size()];
  Order listed = rows[0];
  if (order == ConditionOrder::kListed) return listed;
  Random random(seedFor(seedFor(seedFor(seed, kOrders), static_cast<std::uint64_t>(participant)),
                        static_cast<std::uint64_t>(block)));
  shuffle(listed, random);
  return listed;
}

void requireNamed(const std::vector<NamedCondition>& conditions, const std::string& of) {
  if (conditions.empty()) throw ParameterError("conditions", of + ": conditions is empty. Give at least one.");
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const std::string path = fmt::format("conditions[{}]", k);
    if (conditions[k].name.empty())
      throw ParameterError(path, fmt::format("{}: {} has an empty name. Tables need one.", of, path));
    for (std::size_t other = 0; other < k; ++other) {
      if (conditions[other].name == conditions[k].name)
        throw ParameterError(path, fmt::format("{}: condition \"{}\" is given twice. Name each condition once.", of,
                                               conditions[k].name));
    }
  }
}

std::unique_ptr<WornFinger> Experiment::wornBy(const FingerPlace& place, OneFingerObserver& observer) const {
  if (host_.finger) return host_.finger(place);
  return std::make_unique<SimulatedFinger>(place, observer);
}

bool Experiment::serve(FingerTrial& cycle, const StudyTrial& trial, const std::atomic<bool>& interrupted,
                       ServoReport& served) const {
  cycle.begin();
  const TrialPlace place{trial.index + 1, static_cast<std::int64_t>(trial.run->list.size()), tasks::conditionOf(trial)};
  const ServoReport report = host_.serve ? host_.serve(cycle, place) : runServo(servo_, cycle, interrupted);
  served.add(report);
  if (report.interrupted) return false;
  cycle.finish();
  return cycle.fault().empty() || !host_.arm || host_.arm(cycle.fault());
}

StudyOutcome runStudy(Experiment& experiment, std::uint64_t seed, const std::vector<ResponseRecord>& earlier,
                      StudySink& sink, const std::atomic<bool>& interrupted,
                      const std::function<void(const StudyProgress&)>& progress) {
  StudyOutcome outcome = StudyRunner(experiment, seed, earlier, sink, interrupted).run(progress);
  return outcome;
}

}  // namespace pincer::tasks
