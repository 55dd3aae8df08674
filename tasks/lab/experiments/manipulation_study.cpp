#include "pincer/tasks/lab/experiments/manipulation_study.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/tasks/lab/experiments/cylinder_trial.h"
#include "pincer/tasks/lab/experiments/pickup_trial.h"
#include "pincer/tasks/lab/experiments/simulated_hands.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"

namespace pincer::tasks {
namespace {

// "align", "train", "block"
constexpr std::uint64_t kAlignmentSeed = 0x616c69676e, kTrainingSeed = 0x747261696e, kBlockSeed = 0x626c6f636b;

// Of a time through all conditions, from 0.
std::uint64_t blockSeed(const ManipulationStudy& study, int block) {
  return block == 0 ? study.seed : seedFor(study.seed, kBlockSeed + static_cast<std::uint64_t>(block));
}

SpherePickupOptions pickupOf(const ManipulationStudy& study, bool training, int block) {
  SpherePickupOptions options = study.pickup;
  options.conditions = study.conditions;
  options.participants = study.participants;
  options.seed = training ? seedFor(blockSeed(study, block), kTrainingSeed) : blockSeed(study, block);
  return options;
}

class TrialList {
 public:
  explicit TrialList(const ManipulationStudy& study) : study_(study) {}

  std::vector<ManipulationTrial> take() {
    for (std::int64_t person = 0; person < study_.participants; ++person) {
      index_ = 0;
      for (int block = 0; block < study_.session.blocks; ++block) addBlock(person, block);
    }
    return std::move(trials_);
  }

 private:
  void addBlock(std::int64_t person, int block) {
    counted_ = pickupTrialsOf(pickupOf(study_, false, block), person);
    trained_ = pickupTrialsOf(pickupOf(study_, true, block), person);
    for (const int place : conditionOrder(study_.session.order, study_.conditions.size(), person, block, study_.seed))
      addPart(person, study_.conditions[static_cast<std::size_t>(place)], block);
  }

  void addPart(std::int64_t person, const HandCondition& condition, int block) {
    if (has(study_, HandTask::kPickup)) {
      addPickups(trained_, condition, study_.training.pickups, true);
      addPickups(counted_, condition, std::numeric_limits<int>::max(), false);
    }
    if (has(study_, HandTask::kAlignment)) {
      addAlignments(person, condition, block, study_.training.alignments, true);
      addAlignments(person, condition, block, study_.alignment.repetitions, false);
    }
  }

  void addPickups(const std::vector<PickupTrialSpec>& all, const HandCondition& condition, int most, bool training) {
    int added = 0;
    for (const PickupTrialSpec& spec : all) {
      if (spec.condition.name != condition.name || added == most) continue;
      ManipulationTrial trial;
      trial.pickup = spec;
      trial.pickup.trial = next();
      trial.pickup.index = index_++;
      trial.pickup.training = training;
      trials_.push_back(trial);
      ++added;
    }
  }

  void addAlignments(std::int64_t person, const HandCondition& condition, int block, int count, bool training) {
    const std::uint64_t person_seed =
        seedFor(seedFor(blockSeed(study_, block), static_cast<std::uint64_t>(person)), kAlignmentSeed);
    const std::uint64_t part_seed = seedFor(person_seed, 2 * seedPartOf(condition) + (training ? 1 : 0));
    const std::vector<double> starts = startAngles(study_.alignment, count, part_seed);
    for (std::size_t k = 0; k < starts.size(); ++k) {
      ManipulationTrial trial;
      trial.task = HandTask::kAlignment;
      trial.alignment = {next(), person, index_++, condition, starts[k], seedFor(part_seed, k), training};
      trials_.push_back(trial);
    }
  }

  std::int64_t next() const { return static_cast<std::int64_t>(trials_.size()); }

  const ManipulationStudy& study_;
  std::vector<PickupTrialSpec> counted_, trained_;  // of one participant in one block
  std::vector<ManipulationTrial> trials_;
  std::int64_t index_ = 0;
};

}  // namespace

void validate(const ManipulationStudy& study) {
  visitParameters(study, RangeCheck("study"));
  visitParameters(study.training, RangeCheck("study: training", "training"));
  visitParameters(study.people, RangeCheck("study: people", "people"));
  visitParameters(study.session, RangeCheck("study: session", "session"));
  validate(study.session, "study");
  if (study.tasks.empty())
    throw ParameterError("tasks", "study: tasks is empty. Give sphere-pickup, cylinder-alignment, or both.");
  validate(pickupOf(study, false, 0));
  CylinderAlignmentOptions alignment = study.alignment;
  alignment.conditions = study.conditions;
  validate(alignment);
}

bool has(const ManipulationStudy& study, HandTask task) {
  return std::find(study.tasks.begin(), study.tasks.end(), task) != study.tasks.end();
}

std::string taskName(const ManipulationStudy& study) {
  if (has(study, HandTask::kPickup) && has(study, HandTask::kAlignment)) return "manipulation";
  return has(study, HandTask::kPickup) ? "sphere-pickup" : "cylinder-alignment";
}

std::vector<ManipulationTrial> manipulationTrials(const ManipulationStudy& study) {
  validate(study);
  return TrialList(study).take();
}

PickupObjects makePickupObjects(const ManipulationStudy& study) {
  PickupObjects objects;
  for (const HandCondition& condition : study.conditions)
    objects[condition.name] = makePickupObject(inCondition(study.pickup, condition));
  return objects;
}

std::unique_ptr<HandTrial> makeTrial(const ManipulationStudy& study, const PickupObjects& objects,
                                     const ManipulationTrial& trial, RecordSink& sink) {
  std::unique_ptr<HandTrial> made;
  const HandCondition& condition = trial.condition();
  if (trial.task == HandTask::kPickup) {
    const PickupObject& object = objects.at(condition.name);
    made = std::make_unique<PickupTrial>(inCondition(study.pickup, condition), object, trial.pickup, sink);
  } else {
    made = std::make_unique<CylinderTrial>(inCondition(study.alignment, condition), trial.alignment, sink);
  }
  if (study.frozen_tactor) made->parkTactors();
  return made;
}

std::unique_ptr<Participant> makeParticipant(const ManipulationStudy& study, const ManipulationTrial& trial) {
  const std::uint64_t seed = seedFor(study.seed, static_cast<std::uint64_t>(trial.participant()));
  return makeParticipant(study.people, trial.task, seed, trial.condition().display_tactile);
}

namespace {

std::string partName(const ManipulationTrial& spec) {
  const bool training = spec.task == HandTask::kPickup ? spec.pickup.training : spec.alignment.training;
  return fmt::format("{}, {}{}", spec.task == HandTask::kPickup ? "sphere pickup" : "cylinder alignment",
                     spec.condition().label, training ? ", training" : "");
}

// The text that a person reads before a part.
StudyPage partPage(const ManipulationStudy& study, const ManipulationTrial& spec, bool rests) {
  StudyPage page{partName(spec), study.session.instructions};
  if (page.lines.empty()) {
    if (spec.task == HandTask::kPickup)
      page.lines = {
          "Pinch the sphere between index finger and thumb, lift it by 50 mm and hold it there for a second."};
    else
      page.lines = {"Find the flat of the cylinder, then turn the cylinder so that the flat faces the monitor.",
                    "Enter says that it does."};
    page.lines.push_back("A tone begins each trial, another one ends it.");
  }
  if (rests) page.lines.push_back("Rest as long as you like before you go on.");
  return page;
}

// One trial by whoever does it. `fault`: why a gate tripped; empty: none did.
struct DoneTrial {
  ServoReport servo;
  std::string fault;
};
DoneTrial runTrial(const ManipulationStudy& study, HandTrial& trial, const ManipulationTrial& spec,
                   const ServoOptions& servo, const std::atomic<bool>& interrupted, const StudyHooks& hooks,
                   const TrialProgress& at) {
  const std::unique_ptr<Participant> participant = makeParticipant(study, spec);
  const std::unique_ptr<Hands> hands =
      hooks.host.hands ? hooks.host.hands(trial) : std::make_unique<SimulatedHands>(trial.scene(), *participant);
  trial.begin();
  HandsCycle cycle(trial, *hands, servo.clock != ServoClock::kVirtual);
  DoneTrial done;
  done.servo = hooks.host.serve ? hooks.host.serve(cycle, at.done, at.total) : runServo(servo, cycle, interrupted);
  hands->stop();
  done.fault = trial.fault();
  return done;
}

}  // namespace

std::size_t runManipulationStudy(const ManipulationStudy& study, const ServoOptions& servo, RecordSink& sink,
                                 const std::atomic<bool>& interrupted, const StudyHooks& hooks) {
  auto trials = manipulationTrials(study);
  if (hooks.host.person)
    std::erase_if(trials, [&](const ManipulationTrial& t) { return t.participant() != *hooks.host.person; });
  const PickupObjects objects = makePickupObjects(study);
  const auto report = [&](std::size_t done) {
    if (hooks.progress) hooks.progress({done, trials.size()});
  };
  std::size_t done = hooks.finished.size();
  if (hooks.host.arm && !hooks.host.arm("The session begins.")) return done;
  report(done);
  std::string begun;  // the part that goes on: one task in one condition, training or not
  for (const ManipulationTrial& spec : trials) {
    if (hooks.finished.contains(spec.trial())) continue;
    const std::string part = fmt::format("{}, {}", spec.participant(), partName(spec));
    if (part != begun && hooks.host.show && !hooks.host.show(partPage(study, spec, !begun.empty()))) break;
    begun = part;
    const std::unique_ptr<HandTrial> trial = makeTrial(study, objects, spec, sink);
    const DoneTrial ended = runTrial(study, *trial, spec, servo, interrupted, hooks, {done, trials.size()});
    if (hooks.served) hooks.served(ended.servo);
    if (ended.servo.interrupted) break;
    trial->finish();
    report(++done);
    const bool goes_on = ended.fault.empty() || done == trials.size() || !hooks.host.arm || hooks.host.arm(ended.fault);
    if (!goes_on) break;
  }
  return done;
}

}  // namespace pincer::tasks
