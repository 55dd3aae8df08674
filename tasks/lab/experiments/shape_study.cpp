#include "pincer/tasks/lab/experiments/shape_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/study/counterbalance.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kModelOrder = 4, kExplorer = 5, kWayOfPoints = 6, kUnrelated = 7;  // parts of seeds
constexpr int kRunsOfGroup = 2;            // in a session, one after the other
constexpr double kPublishedRight = 0.819;  // of all conditions together

int solidOf(const std::string& name) {
  return static_cast<int>(std::find(kSolidNames.begin(), kSolidNames.end(), name) - kSolidNames.begin());
}

// "1 cone  2 cylinder ...": the keys that answer.
std::string namesAndKeys() {
  std::string text;
  for (std::size_t k = 0; k < kSolids; ++k) text += fmt::format("{}{} {}", k > 0 ? "   " : "", k + 1, kSolidNames[k]);
  return text;
}

void requireEven(const char* name, int value) {
  if (value % 2 == 0) return;
  throw ParameterError(
      fmt::format("sizes.{}", name),
      fmt::format("shape-identification: {} = {} is odd, but an even number is needed. {}", name, value, kAsPublished));
}

}  // namespace

std::vector<ShapeCondition> ShapeStudy::published() {
  return {{"facets", "facets, force only", false, false, 1, kPublishedRight},
          {"facets+cld", "facets, CLD + force", false, true, 2, kPublishedRight},
          {"shaded", "shaded, force only", true, false, 1, kPublishedRight},
          {"shaded+cld", "shaded, CLD + force", true, true, 2, kPublishedRight}};
}

void validate(const ShapeStudy& s) {
  const RangeCheck check("shape-identification");
  visitParameters(s, check);
  visitParameters(s.sizes, RangeCheck("shape-identification: sizes", "sizes"));
  requireEven("sides", s.sizes.sides);
  requireEven("facet_sides", s.sizes.facet_sides);
  if (s.tactor_reach > s.finger_radius)
    throw ParameterError("tactor_reach",
                         fmt::format("shape-identification: tactor_reach = {} is out of range (0, finger_radius]. {}",
                                     s.tactor_reach, kAsPublished));
  visitParameters(s.session, RangeCheck("shape-identification: session", "session"));
  validate(s.session, "shape-identification");
  requireNamed(s.conditions, "shape-identification");
  for (std::size_t k = 0; k < s.conditions.size(); ++k)
    visitParameters(s.conditions[k], RangeCheck("shape-identification: condition " + printable(s.conditions[k].name),
                                                fmt::format("conditions[{}]", k)));
}

ShapeExperiment::ShapeExperiment(const ShapeStudy& study, const ServoOptions& servo, int stride)
    : Experiment(servo), study_(study), stride_(stride) {
  validate(study);
  for (std::size_t k = 0; k < kSolids; ++k) {
    for (const bool shaded : {false, true}) {
      for (const bool left : {false, true}) {
        auto& solid = solids_[shaded][left][k];
        const bool same = left && !isPointed(kSolidNames[k]);
        solid = same ? solids_[shaded][false][k] : makeSolid(kSolidNames[k], shaded, study.sizes, left);
      }
    }
  }
}

// Models of the group's conditions. In the first of its two runs of a session a pointed one points to a side that is
// drawn, in the second to the other.
StudyRun ShapeExperiment::runOf(int participant, int run, int group) const {
  StudyRun shown{participant, run, "", {}, {}};
  const auto place = static_cast<std::uint64_t>(participant * runsOfPerson() + run), pair = place / kRunsOfGroup;
  Random sides(seedFor(seedFor(study_.seed, kWayOfPoints), pair));
  for (const ShapeCondition& c : study_.conditions) {
    for (const char* solid : kSolidNames) {
      if (c.group != group) continue;
      const double side = sides.below(2) == static_cast<std::uint64_t>(run % 2) ? 1 : -1;
      shown.list.push_back({solid, isPointed(solid) ? side : std::nan(""), c.name});
    }
  }
  Random random(seedFor(seedFor(study_.seed, kModelOrder), place));
  shuffle(shown.list, random);
  return shown;
}

std::vector<int> ShapeExperiment::groups() const {
  std::set<int> groups;
  for (const ShapeCondition& c : study_.conditions) groups.insert(c.group);
  return {groups.begin(), groups.end()};
}

int ShapeExperiment::runsOfPerson() const {
  return study_.sessions * study_.session.blocks * kRunsOfGroup * static_cast<int>(groups().size());
}

// Every session of a participant has the same order of groups; within it they are gone through `blocks` times.
std::vector<StudyRun> ShapeExperiment::runs() const {
  const std::vector<int> groups = this->groups();
  std::vector<StudyRun> runs;
  for (int p = 0; p < study_.participants; ++p) {
    int run = 0;
    for (int pass = 0; pass < study_.sessions * study_.session.blocks; ++pass) {
      const int block = pass % study_.session.blocks;
      for (const int place : conditionOrder(study_.session.order, groups.size(), p, block, study_.seed)) {
        for (int k = 0; k < kRunsOfGroup; ++k) runs.push_back(runOf(p, run++, groups[static_cast<std::size_t>(place)]));
      }
    }
  }
  return runs;
}

std::shared_ptr<const contact::SmoothMesh> ShapeExperiment::modelOf(const StudyTrial& trial,
                                                                    const ShapeCondition& condition) const {
  if (!study_.unrelated)
    return solids_[condition.shaded][trial.stimulus.level < 0][static_cast<std::size_t>(solidOf(trial.stimulus.name))];
  Random random(seedFor(trial.seed, kUnrelated));
  const Solids& solids = solids_[random.below(2)][random.below(2)];
  return solids[random.below(kSolids)];
}

ShapeTrialSetup ShapeExperiment::setupOf(const StudyTrial& trial, const ShapeCondition& condition) const {
  ShapeTrialSetup setup;
  setup.solid = modelOf(trial, condition);
  setup.display_tactile = condition.display_tactile && !study_.frozen_tactor;
  setup.friction = study_.friction;
  setup.finger_radius = study_.finger_radius;
  setup.stiffness = study_.stiffness;
  setup.tactor_reach = study_.tactor_reach;
  setup.asked.trial = trial.trial;
  setup.asked.stride = stride_;
  setup.asked.training = trial.training;
  setup.asked.texts.feel = namesAndKeys();
  return setup;
}

std::optional<ResponseRecord> ShapeExperiment::present(const StudyTrial& trial, StudySink& sink,
                                                       const std::atomic<bool>& interrupted, ServoReport& served) {
  const auto condition = std::find_if(study_.conditions.begin(), study_.conditions.end(),
                                      [&](const ShapeCondition& c) { return c.name == trial.stimulus.condition; });
  const ShapeTrialSetup setup = setupOf(trial, *condition);
  ShapeExplorer explorer(trial.person_seed);
  explorer.begin(shapeCues(setup, seedFor(trial.seed, kExplorer)));
  const auto finger = wornBy(shapePlace(setup), explorer);
  ShapeTrial cycle(setup, *finger, sink);
  if (!serve(cycle, trial, interrupted, served)) return std::nullopt;
  const int named = cycle.isPersons() ? cycle.chosen() - 1 : explorer.answer();
  ResponseRecord response;
  response.stimulus = trial.stimulus.name;
  response.level = trial.stimulus.level;
  response.answer_value = cycle.isPersons() ? std::nan("") : explorer.sureness();
  response.answer = cycle.answered() ? kSolidNames[static_cast<std::size_t>(named)] : "";
  response.correct = response.answer == response.stimulus;
  cycle.measure(response);
  return response;
}

StudyPage ShapeExperiment::introduction(const StudyRun&) const {
  return {"Which solid is it?",
          {"One of seven solids stands before you. Explore it with the finger as long as you like, but answer as "
           "quickly as is comfortable.",
           "The key of its name ends the trial; you can't change your mind:", namesAndKeys()}};
}

std::vector<ListedStimulus> ShapeExperiment::training(const StudyRun& run) const { return {run.list.front()}; }

std::string ShapeExperiment::feedback(const ResponseRecord& response) const {
  return fmt::format("It was the {}; you said {}.", response.stimulus, response.answer);
}

}  // namespace pincer::tasks
