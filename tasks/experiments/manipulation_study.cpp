#include "tasks/experiments/manipulation_study.h"

#include <fmt/format.h>

#include "tasks/experiments/cylinder_trial.h"
#include "tasks/experiments/pickup_trial.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kAlignmentSeed = 0x616c69676e, kTrainingSeed = 0x747261696e;  // "align", "train"

void requireCount(const char* name, int value, int low, int high, const char* remedy) {
  if (value >= low && value <= high) return;
  throw InputError(fmt::format("study: {} = {} is out of range [{}, {}]. {}", name, value, low, high, remedy));
}

SpherePickupOptions pickupOf(const ManipulationStudy& study, bool training) {
  SpherePickupOptions options = study.pickup;
  options.conditions = study.conditions;
  options.participants = study.participants;
  options.seed = training ? seedFor(study.seed, kTrainingSeed) : study.seed;
  return options;
}

class TrialList {
 public:
  explicit TrialList(const ManipulationStudy& study)
      : study_(study), counted_(pickupTrials(pickupOf(study, false))), trained_(pickupTrials(pickupOf(study, true))) {}

  std::vector<ManipulationTrial> take() {
    for (std::int64_t person = 0; person < study_.participants; ++person) {
      index_ = 0;
      for (std::size_t half = 0; half < study_.conditions.size(); ++half) addHalf(person, half);
    }
    return std::move(trials_);
  }

 private:
  void addHalf(std::int64_t person, std::size_t half) {
    const std::size_t place = person % 2 == 1 ? study_.conditions.size() - 1 - half : half;
    const PickupCondition condition = study_.conditions[place];
    if (study_.pickup_task) {
      addPickups(trained_, person, condition, study_.training_pickups, true);
      addPickups(counted_, person, condition, std::numeric_limits<int>::max(), false);
    }
    if (study_.alignment_task) {
      addAlignments(person, condition, study_.training_alignments, true);
      addAlignments(person, condition, study_.alignment.repetitions, false);
    }
  }

  void addPickups(const std::vector<PickupTrialSpec>& all, std::int64_t person, PickupCondition condition, int most, bool training) {
    int added = 0;
    for (const PickupTrialSpec& spec : all) {
      if (spec.participant != person || spec.condition != condition || added == most) continue;
      ManipulationTrial trial;
      trial.pickup = spec;
      trial.pickup.trial = next();
      trial.pickup.index = index_++;
      trial.pickup.training = training;
      trials_.push_back(trial);
      ++added;
    }
  }

  void addAlignments(std::int64_t person, PickupCondition condition, int count, bool training) {
    const std::uint64_t person_seed = seedFor(seedFor(study_.seed, static_cast<std::uint64_t>(person)), kAlignmentSeed);
    const std::uint64_t block_seed = seedFor(person_seed, 2 * static_cast<std::uint64_t>(condition) + (training ? 1 : 0));
    const std::vector<double> starts = startAngles(study_.alignment, count, block_seed);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      ManipulationTrial trial;
      trial.task = HandTask::kAlignment;
      trial.alignment = {next(), person, index_++, condition, starts[k], seedFor(block_seed, k), training};
      trials_.push_back(trial);
    }
  }

  std::int64_t next() const { return static_cast<std::int64_t>(trials_.size()); }

  const ManipulationStudy& study_;
  std::vector<PickupTrialSpec> counted_, trained_;
  std::vector<ManipulationTrial> trials_;
  std::int64_t index_ = 0;
};

void requireParameters(const ParticipantModel& people) {
  forEachParameter(people, [](const char* name, double value, double low, double high, const char* unit) {
    if (value >= low && value <= high) return;  // also false for NaN
    throw InputError(fmt::format("study: people.{} = {} is out of range [{}, {}]{}{}. Leave it out for the default.", name, value, low,
                                 high, *unit ? " " : "", unit));
  });
}

}  // namespace

void validate(const ManipulationStudy& study) {
  requireCount("participants", study.participants, 1, 1000, "The published study had 12.");
  requireCount("training_pickups", study.training_pickups, 0, 100, "So many trials come before the counted ones; 2 is usual.");
  requireCount("training_alignments", study.training_alignments, 0, 100, "So many trials come before the counted ones; 1 is usual.");
  if (!study.pickup_task && !study.alignment_task)
    throw InputError("study: tasks is empty. Give sphere-pickup, cylinder-alignment, or both.");
  validate(pickupOf(study, false));
  CylinderAlignmentOptions alignment = study.alignment;
  alignment.conditions = study.conditions;
  validate(alignment);
  requireParameters(study.people);
}

std::string taskName(const ManipulationStudy& study) {
  if (study.pickup_task && study.alignment_task) return "manipulation";
  return study.pickup_task ? "sphere-pickup" : "cylinder-alignment";
}

std::vector<ManipulationTrial> manipulationTrials(const ManipulationStudy& study) {
  validate(study);
  return TrialList(study).take();
}

std::unique_ptr<HandTrial> makeTrial(const ManipulationStudy& study, const PickupObject& object, const ManipulationTrial& trial,
                                     RecordSink& sink) {
  std::unique_ptr<HandTrial> made;
  if (trial.task == HandTask::kPickup) {
    made = std::make_unique<PickupTrial>(study.pickup, object, trial.pickup, sink);
  } else {
    made = std::make_unique<CylinderTrial>(study.alignment, trial.alignment, sink);
  }
  if (study.frozen_tactor) made->parkTactors();
  return made;
}

std::unique_ptr<Participant> makeParticipant(const ManipulationStudy& study, const ManipulationTrial& trial) {
  const std::uint64_t seed = seedFor(study.seed, static_cast<std::uint64_t>(trial.participant()));
  return makeParticipant(study.people, trial.task, seed, trial.condition() == PickupCondition::kCldForce);
}

std::size_t runManipulationStudy(const ManipulationStudy& study, const ServoOptions& servo, RecordSink& sink,
                                 const std::atomic<bool>& interrupted, const StudyHooks& hooks) {
  const auto trials = manipulationTrials(study);
  const PickupObject object = makePickupObject(study.pickup);
  const auto report = [&](std::size_t done) {
    if (hooks.progress) hooks.progress({done, trials.size()});
  };
  std::size_t done = hooks.finished.size();
  report(done);
  for (const ManipulationTrial& trial : trials) {
    if (hooks.finished.contains(trial.trial())) continue;
    const std::unique_ptr<Participant> participant = makeParticipant(study, trial);
    SimulatedTrial cycle(makeTrial(study, object, trial, sink), *participant);
    const ServoReport servo_report = runServo(servo, cycle, interrupted);
    if (hooks.served) hooks.served(servo_report);
    if (servo_report.interrupted) break;
    cycle.finish();
    report(++done);
  }
  return done;
}

}  // namespace pincer::tasks
