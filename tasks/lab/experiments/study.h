// study: what all psychophysical experiments share: whom is shown what in which
// order, answers into records, trial by trial.
//
// A study is a list of runs, one participant's each: a staircase, which chooses its next level from the answers,
// or a list of trials. All that happens in a trial follows from the study's parameters, the trial's place and the
// seed: the same seed gives the same session, and a session that was cut short goes on where it ended, its
// finished answers fed to the staircases again.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pincer/tasks/lab/finger/finger_host.h"
#include "pincer/tasks/lab/study/counterbalance.h"
#include "pincer/tasks/lab/study/staircase.h"
#include "pincer/tasks/lab/study/survey.h"
#include "pincer/tasks/run/records.h"
#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {

struct ListedStimulus {
  std::string name;
  double level = 0;
  std::string condition = {};  // where a run mixes them; else empty
};

struct StudyRun {
  std::int64_t participant = 0, run = 0;
  std::string condition;  // of all its trials; empty: each has its own
  std::optional<StaircaseRule> staircase;
  std::vector<ListedStimulus> list;  // where there is no staircase
};

// In which order the participant does `count` conditions, in the block.
Order conditionOrder(ConditionOrder order, std::size_t count, std::int64_t participant, int block, std::uint64_t seed);

template <class Condition>
std::vector<NamedCondition> namedOf(const std::vector<Condition>& conditions) {
  std::vector<NamedCondition> named;
  for (const Condition& c : conditions) named.push_back({c.name, c.label});
  return named;
}

// Throws ParameterError unless there is at least one, each with a name of its own.
void requireNamed(const std::vector<NamedCondition>& conditions, const std::string& of);
template <class Condition>
void requireNamed(const std::vector<Condition>& conditions, const std::string& of) {
  requireNamed(namedOf(conditions), of);
}

// One trial to be presented.
struct StudyTrial {
  std::int64_t trial = 0, index = 0;  // in the session, in the run
  const StudyRun* run = nullptr;
  ListedStimulus stimulus;
  std::uint64_t seed = 0;         // of the trial
  std::uint64_t person_seed = 0;  // of the participant
  bool training = false;          // before the counted ones: what is felt is seen, nothing is kept
};

class Experiment {
 public:
  explicit Experiment(const ServoOptions& servo) : servo_(servo) {}
  virtual ~Experiment() = default;
  virtual std::vector<StudyRun> runs() const = 0;
  // Shows the trial to its participant and takes the answer: stimulus, level, interval, answer, correct,
  // outcome and what is measured; the rest is filled in by the caller. Absent if `interrupted` turned
  // true. Adds what the servo says to `served`.
  virtual std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink& sink,
                                                const std::atomic<bool>& interrupted, ServoReport& served) = 0;
  // The text that a person reads before the run, and stimuli to train with, in turn; at least one.
  virtual StudyPage introduction(const StudyRun& run) const = 0;
  virtual std::vector<ListedStimulus> training(const StudyRun& run) const = 0;
  virtual const SurveyPlan& plan() const = 0;
  virtual std::vector<NamedCondition> conditions() const = 0;
  // The right answer, said after a trial of training: "The second was the smooth one; you said 1."
  virtual std::string feedback(const ResponseRecord& response) const = 0;

  // From now on these do the trials.
  void serveWith(const FingerHost& host) { host_ = host; }
  const FingerHost& host() const { return host_; }

 protected:
  // Whoever wears the finger: the host's, or a simulated participant, who has begun and outlives it.
  std::unique_ptr<WornFinger> wornBy(const FingerPlace& place, OneFingerObserver& observer) const;
  // Runs the trial. False if `interrupted` turned true, or the operator doesn't switch forces on again after a fault.
  bool serve(FingerTrial& cycle, const StudyTrial& trial, const std::atomic<bool>& interrupted,
             ServoReport& served) const;

 private:
  ServoOptions servo_;
  FingerHost host_;
};

struct StudyProgress {
  double share = 0;  // of the study that is done
};

struct StudyOutcome {
  std::int64_t trials = 0;  // finished, earlier ones included
  bool interrupted = false;
  ServoReport servo;
  std::optional<std::uint64_t> samples_hash{};  // SessionWriter::samplesHash(), of a session in a file
};

// Runs the study from the first trial that isn't among `earlier`, which are an earlier session's, in
// order. A person reads an introduction before each run, trains, and may rest. Throws InputError
// where the earlier ones don't fit the study.
StudyOutcome runStudy(Experiment& experiment, std::uint64_t seed, const std::vector<ResponseRecord>& earlier,
                      StudySink& sink, const std::atomic<bool>& interrupted,
                      const std::function<void(const StudyProgress&)>& progress = {});

}  // namespace pincer::tasks
