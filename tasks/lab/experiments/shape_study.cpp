#include "pincer/tasks/lab/experiments/shape_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/study/counterbalance.h"

namespace pincer::tasks {
namespace {

constexpr std::uint64_t kModelOrder = 4, kExplorer = 5;  // parts of seeds
constexpr double kPublishedRight = 0.819;                // of all conditions together

int solidOf(const std::string& name) {
  return static_cast<int>(std::find(kSolidNames.begin(), kSolidNames.end(), name) - kSolidNames.begin());
}

// "1 cone  2 cylinder ...": the keys that answer.
std::string namesAndKeys() {
  std::string text;
  for (std::size_t k = 0; k < kSolids; ++k) text += fmt::format("{}{} {}", k > 0 ? "   " : "", k + 1, kSolidNames[k]);
  return text;
}

}  // namespace

std::vector<ShapeCondition> ShapeStudy::published() {
  return {{"facets", "facets, force only", false, false, kPublishedRight},
          {"facets+cld", "facets, CLD + force", false, true, kPublishedRight},
          {"shaded", "shaded, force only", true, false, kPublishedRight},
          {"shaded+cld", "shaded, CLD + force", true, true, kPublishedRight}};
}

void validate(const ShapeStudy& s) {
  const RangeCheck check("shape-identification");
  visitParameters(s, check);
  visitParameters(s.sizes, RangeCheck("shape-identification: sizes", "sizes"));
  if (s.sizes.sides % 2 != 0)
    throw ParameterError("sizes.sides", fmt::format("shape-identification: sides = {} is odd, but an even number is needed. {}",
                                                    s.sizes.sides, kAsPublished));
  visitParameters(s.session, RangeCheck("shape-identification: session", "session"));
  validate(s.session, "shape-identification");
  requireOneBlock(s.session, "shape-identification", false);
  if (s.conditions.empty()) throw ParameterError("conditions", "shape-identification: conditions is empty. Give at least one.");
}

ShapeExperiment::ShapeExperiment(const ShapeStudy& study, const ServoOptions& servo, int stride)
    : Experiment(servo), study_(study), stride_(stride) {
  validate(study);
  for (std::size_t k = 0; k < kSolids; ++k) {
    for (const bool shaded : {false, true}) solids_[shaded][k] = makeSolid(kSolidNames[k], shaded, study.sizes);
  }
}

// A run shows the models of the conditions with the display, or of those without.
std::vector<StudyRun> ShapeExperiment::runs() const {
  std::vector<StudyRun> runs;
  for (int p = 0; p < study_.participants; ++p) {
    for (int k = 0; k < study_.runs; ++k) {
      const bool display = (p + k) % 2 == 1;
      StudyRun run{p, k, "", {}, {}};
      for (const ShapeCondition& c : study_.conditions) {
        for (const char* solid : kSolidNames)
          if (c.display_tactile == display) run.list.push_back({solid, std::nan(""), c.name});
      }
      if (run.list.empty()) continue;
      Random random(seedFor(seedFor(study_.seed, kModelOrder), static_cast<std::uint64_t>(p * study_.runs + k)));
      shuffle(run.list, random);
      runs.push_back(std::move(run));
    }
  }
  return runs;
}

std::optional<ResponseRecord> ShapeExperiment::present(const StudyTrial& trial, StudySink& sink, const std::atomic<bool>& interrupted,
                                                       ServoReport& served) {
  const auto condition = std::find_if(study_.conditions.begin(), study_.conditions.end(),
                                      [&](const ShapeCondition& c) { return c.name == trial.stimulus.condition; });
  const auto solid = static_cast<std::size_t>(solidOf(trial.stimulus.name));
  ShapeTrialSetup setup;
  setup.solid = solids_[condition->shaded][solid];
  setup.display_tactile = condition->display_tactile;
  setup.friction = study_.friction;
  setup.finger_radius = study_.finger_radius;
  setup.stiffness = study_.stiffness;
  setup.asked.trial = trial.trial;
  setup.asked.stride = stride_;
  setup.asked.training = trial.training;
  setup.asked.texts.feel = namesAndKeys();
  ShapeExplorer explorer(trial.person_seed);
  explorer.begin(shapeCues(setup, seedFor(trial.seed, kExplorer)));
  const auto finger = wornBy(shapePlace(setup), explorer);
  ShapeTrial cycle(setup, *finger, sink);
  if (!serve(cycle, trial, interrupted, served)) return std::nullopt;
  const int named = cycle.isPersons() ? cycle.chosen() - 1 : explorer.answer();
  ResponseRecord response;
  response.stimulus = trial.stimulus.name;
  response.level = std::nan("");
  response.answer_value = cycle.isPersons() ? std::nan("") : explorer.sureness();
  response.answer = cycle.answered() ? kSolidNames[static_cast<std::size_t>(named)] : "";
  response.correct = response.answer == response.stimulus;
  cycle.measure(response);
  return response;
}

StudyPage ShapeExperiment::introduction(const StudyRun&) const {
  return {
      "Which solid is it?",
      {"One of seven solids stands before you. Explore it with the finger as long as you like, but answer as quickly as is comfortable.",
       "The key of its name ends the trial; you can't change your mind:", namesAndKeys()}};
}

std::vector<ListedStimulus> ShapeExperiment::training(const StudyRun& run) const { return {run.list.front()}; }

std::string ShapeExperiment::feedback(const ResponseRecord& response) const {
  return fmt::format("It was the {}; you said {}.", response.stimulus, response.answer);
}

}  // namespace pincer::tasks
