#include "pincer/tasks/lab/experiments/arc_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/polytope.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/participants/random.h"
#include "pincer/tasks/lab/study/arc_segments.h"
#include "pincer/tasks/lab/study/counterbalance.h"

namespace pincer::tasks {
namespace {

using contact::SurfaceVariant;

constexpr double kLargestTurn = 0.5;                        // of a polygon that still covers the strokes [rad]
constexpr double kBladeFlank = 0.03;                        // length of its sides [m]
constexpr std::uint64_t kWhichInterval = 1, kWhoFeels = 2;  // parts of a trial's seed

StaircaseRule smoothnessRule() {
  return {.start = 12 * kDegree,
          .large_step = 0.5,
          .small_step = 0.15,
          .steps_are_ratios = true,
          .large_reversals = 3,
          .reversals = 11,
          .averaged = 6,
          .lowest = 0.02 * kDegree,
          .highest = kLargestTurn,
          .most_trials = 200};
}

StaircaseRule backlashRule() {
  return {.start = 1.5e-3,
          .large_step = 0.3e-3,
          .small_step = 0.06e-3,
          .large_reversals = 4,
          .reversals = 14,
          .averaged = 10,
          .lowest = 0,
          .highest = 12e-3,
          .most_trials = 200};
}

StaircaseRule delayRule() {
  return {.start = 0.15,
          .large_step = 0.015,
          .small_step = 0.006,
          .large_reversals = 4,
          .reversals = 14,
          .averaged = 10,
          .lowest = 0,
          .highest = 0.5,
          .most_trials = 200};
}

std::shared_ptr<const contact::Curve> sharedCurve(const contact::Polyline& polyline, SurfaceVariant variant) {
  return std::make_shared<const contact::Curve>(polyline, variant);
}

StrokeQuestion questionOf(ArcQuantity quantity, const ArcCondition& condition) {
  if (quantity == ArcQuantity::kTurn) return StrokeQuestion::kRougher;
  if (quantity == ArcQuantity::kBacklash) return StrokeQuestion::kLooser;
  return condition.travel_share < 1 ? StrokeQuestion::kOnset : StrokeQuestion::kLater;
}

TrialTexts textsOf(ArcQuantity quantity) {
  // The task, told before each question.
  constexpr const char* kFeel = "Stroke to and fro as long as you like; then raise the finger and press Enter";
  if (quantity == ArcQuantity::kTurn) return {kFeel, "Which was the smooth one? 1 or 2, then Enter"};
  return {kFeel, quantity == ArcQuantity::kBacklash ? "Which had more backlash? 1 or 2, then Enter"
                                                    : "Which had more delay? 1 or 2, then Enter"};
}

// The range of a condition's levels.
void validate(const ArcStudy& study, std::size_t index) {
  const ArcCondition& c = study.conditions[index];
  const std::string of = fmt::format("{}: condition {}", study.task, printable(c.name)),
                    path = fmt::format("conditions[{}]", index);
  const std::string of_staircase = of + ": staircase", staircase = path + ".staircase";
  visitParameters(c, RangeCheck(of, path));
  visitParameters(c.staircase, RangeCheck(of_staircase, staircase));
  const std::string problem = problemWith(c.staircase);
  if (!problem.empty()) throw ParameterError(staircase, fmt::format("{}: {}.", of_staircase, problem));
  const bool turns = study.quantity == ArcQuantity::kTurn;
  const double most = turns ? kLargestTurn : study.quantity == ArcQuantity::kDelay ? 0.512 : 0.05;
  if (c.staircase.highest <= most && c.staircase.lowest >= (turns ? 1e-5 : 0)) return;
  throw ParameterError(staircase, fmt::format("{}: staircase: levels from {} to {} can't all be shown: a turn in "
                                              "[0.00001, 0.5] rad, a backlash in [0, 0.05] m, a "
                                              "delay in [0, 0.512] s.",
                                              of, c.staircase.lowest, c.staircase.highest));
}

}  // namespace

ArcStudy smoothnessStudy() {
  ArcStudy study;
  study.task = "smoothness-discrimination";
  const StaircaseRule rule = smoothnessRule();
  const auto smooth = SurfaceVariant::smooth, facet = SurfaceVariant::facet, force = SurfaceVariant::force;
  study.conditions = {
      {"C1", "facets, force only", facet, {}, false, 1, rule, 104.1},
      {"C2", "force shading, force only", force, {}, false, 1, rule, 16.3},
      {"C3", "facets in force and on the tactor", facet, facet, false, 1, rule, 257.3},
      {"C4", "facets in force, 2D algorithm on the tactor", facet, smooth, false, 1, rule, 15.6},
      {"P1", "2D algorithm in both (pilot)", smooth, smooth, false, 1, rule, segmentsOf(14.8 * kDegree), true},
      {"P2", "force shading, facets on the tactor (pilot)", force, facet, false, 1, rule, segmentsOf(0.2 * kDegree),
       true}};
  return study;
}

ArcStudy backlashStudy() {
  ArcStudy study;
  study.task = "backlash-discrimination";
  study.participants = 20;
  study.quantity = ArcQuantity::kBacklash;
  study.finger_radius = 0.013;
  study.arc_radius = 0.095;
  const auto smooth = SurfaceVariant::smooth;
  study.conditions = {{"low-curvature", "95 mm cylinder", smooth, smooth, false, 1, backlashRule(), 0.46e-3},
                      {"edge", "2-degree edge", smooth, smooth, true, 1, backlashRule(), 0.93e-3}};
  return study;
}

ArcStudy delayStudy() {
  ArcStudy study = backlashStudy();
  study.task = "delay-discrimination";
  study.quantity = ArcQuantity::kDelay;
  const auto smooth = SurfaceVariant::smooth;
  study.conditions = {
      {"whole", "whole travel", smooth, smooth, false, 1, delayRule(), 0.061},
      {"front-end", "tactor frozen after two thirds of a sweep", smooth, smooth, false, 2. / 3, delayRule(), 0.132}};
  return study;
}

void validate(const ArcStudy& study) {
  const RangeCheck check(study.task);
  visitParameters(study, check);
  if (study.tactor_reach > study.finger_radius)
    throw ParameterError(
        "tactor_reach",
        fmt::format("{}: tactor_reach = {} is out of range (0, finger_radius]: a radian of stroke either way. {}",
                    study.task, study.tactor_reach, kAsPublished));
  if (study.strokes % 2 != 0)
    throw ParameterError("strokes", fmt::format("{}: strokes = {} is odd, but every stroke has its way back. {}",
                                                study.task, study.strokes, kAsPublished));
  if (study.conditions.empty())
    throw ParameterError("conditions", study.task + ": conditions is empty. Give at least one.");
  for (std::size_t i = 0; i < study.conditions.size(); ++i) validate(study, i);
  visitParameters(study.session, RangeCheck(study.task + ": session", "session"));
  validate(study.session, study.task);
}

ArcExperiment::ArcExperiment(const ArcStudy& study, const ServoOptions& servo, int stride)
    : Experiment(servo), study_(study), stride_(stride) {
  validate(study);
  arc_ = sharedCurve(contact::arcPolygon(study.arc_radius, study.reference_turn, sweep()), SurfaceVariant::smooth);
  blade_ = sharedCurve(blade(), SurfaceVariant::smooth);
}

std::vector<StudyRun> ArcExperiment::runs() const {
  std::vector<StudyRun> runs;
  std::vector<const ArcCondition*> ordered, pilots;
  for (const ArcCondition& c : study_.conditions) (c.pilot ? pilots : ordered).push_back(&c);
  for (int p = 0; p < study_.participants; ++p) {
    std::int64_t place = 0;
    for (int block = 0; block < study_.session.blocks; ++block) {
      for (const int c : conditionOrder(study_.session.order, ordered.size(), p, block, study_.seed)) {
        const ArcCondition& condition = *ordered[static_cast<std::size_t>(c)];
        runs.push_back({p, place++, condition.name, condition.staircase, {}});
      }
      for (const ArcCondition* c : pilots) runs.push_back({p, place++, c->name, c->staircase, {}});
    }
  }
  return runs;
}

std::optional<ResponseRecord> ArcExperiment::present(const StudyTrial& trial, StudySink& sink,
                                                     const std::atomic<bool>& interrupted, ServoReport& served) {
  const int comparison = 1 + static_cast<int>(Random(seedFor(trial.seed, kWhichInterval)).below(2));
  StrokeObserver observer(trial.person_seed);
  observer.begin(cuesOf(trial));
  const ArcTrialSetup setup = setupOf(trial, comparison, host().isPersons() ? 0 : observer.roll());
  const auto finger = wornBy(arcPlace(setup), observer);
  ArcTrial cycle(setup, *finger, sink);
  if (!serve(cycle, trial, interrupted, served)) return std::nullopt;
  ResponseRecord response;
  response.level = trial.stimulus.level;
  const bool asks_smooth = study_.quantity == ArcQuantity::kTurn;
  const int asked = asks_smooth ? 3 - comparison : comparison;
  const int felt = asks_smooth ? 3 - observer.answer() : observer.answer();  // by a simulated participant
  const int answer = !cycle.answered() ? 0 : cycle.isPersons() ? cycle.chosen() : felt;
  response.interval = asked;
  response.answer = std::to_string(answer);
  response.answer_value = answer;
  response.correct = answer == asked;
  cycle.measure(response);
  return response;
}

const ArcCondition& ArcExperiment::conditionNamed(const std::string& name) const {
  return *std::find_if(study_.conditions.begin(), study_.conditions.end(),
                       [&](const ArcCondition& c) { return c.name == name; });
}

double ArcExperiment::pathRadius(const ArcCondition& condition) const {
  return study_.finger_radius + (condition.edge ? 0 : study_.arc_radius);
}

StrokeCues ArcExperiment::cuesOf(const StudyTrial& trial) const {
  StrokeCues cues;
  cues.seed = seedFor(trial.seed, kWhoFeels);
  cues.radius = pathRadius(conditionOf(trial));
  const Pose X_WD = arcArmBase(cues.radius);
  cues.q_WD = X_WD.q;
  cues.p_WD = X_WD.p;
  cues.half_angle = study_.tactor_reach / study_.finger_radius;
  cues.strokes = study_.strokes;
  cues.tactor_gain = study_.finger_radius / cues.radius;
  cues.rolls = study_.quantity != ArcQuantity::kTurn && !conditionOf(trial).edge;
  cues.question = questionOf(study_.quantity, conditionOf(trial));
  return cues;
}

ArcTrialSetup ArcExperiment::setupOf(const StudyTrial& trial, int comparison, double roll) const {
  const ArcCondition& condition = conditionOf(trial);
  ArcTrialSetup setup;
  setup.finger_radius = study_.finger_radius;
  setup.path_radius = pathRadius(condition);
  setup.start_angle = -study_.tactor_reach / study_.finger_radius / (1 + roll);
  setup.freeze_share = condition.travel_share;
  setup.stiffness = study_.stiffness;
  for (int i = 1; i <= 2; ++i)
    setup.intervals.push_back(intervalOf(condition, i == comparison ? trial.stimulus.level : 0));
  setup.asked.trial = trial.trial;
  setup.asked.stride = stride_;
  setup.asked.training = trial.training;
  setup.asked.texts = textsOf(study_.quantity);
  return setup;
}

// `level` 0: the reference.
ArcInterval ArcExperiment::intervalOf(const ArcCondition& condition, double level) const {
  ArcInterval interval;
  const auto& reference = condition.edge ? blade_ : arc_;
  const bool turned = study_.quantity == ArcQuantity::kTurn && level > 0 && !condition.edge;
  const auto shown = [&](SurfaceVariant variant) {
    return turned ? sharedCurve(contact::arcPolygon(study_.arc_radius, level, sweep()), variant) : reference;
  };
  interval.shown.force = shown(condition.force);
  if (condition.tactile && !study_.frozen_tactor)
    interval.shown.tactile = *condition.tactile == condition.force ? interval.shown.force : shown(*condition.tactile);
  interval.shown.largest_place = study_.tactor_reach;
  interval.picture = pictureOf(condition);
  if (study_.quantity == ArcQuantity::kBacklash) interval.transmission.backlash = level;
  if (study_.quantity == ArcQuantity::kDelay) interval.transmission.delay = static_cast<int>(std::lround(1000 * level));
  return interval;
}

StudyPage ArcExperiment::introduction(const StudyRun& run) const {
  const ArcCondition& condition = conditionNamed(run.condition);
  StudyPage page;
  page.lines = {
      "Two things are felt, one after the other; a tone begins each. Stroke them fore and aft, along the finger.",
      "When you have felt enough, raise the finger and press Enter. There is no way back."};
  if (study_.quantity == ArcQuantity::kTurn) {
    page.title = "Which is the smooth one?";
    page.lines.push_back(
        "One is a smooth arc, the other has flat facets. In the end press 1 or 2 for the smooth one, then Enter.");
  } else if (study_.quantity == ArcQuantity::kBacklash) {
    page.title = "Which has more backlash?";
    page.lines.push_back("On one, the place on your fingerpad lags when you turn back: that is backlash.");
    page.lines.push_back("In the end press 1 or 2 for the one with more of it, then Enter.");
    if (condition.edge) page.lines.push_back("What you feel is an edge that runs from left to right.");
  } else {
    page.title = "Which has more delay?";
    page.lines.push_back("On one, the place on your fingerpad comes later than your finger moves: that is delay.");
    page.lines.push_back("In the end press 1 or 2 for the one with more of it, then Enter.");
    if (condition.travel_share < 1)
      page.lines.push_back("Touch one side, sweep to the other, raise the finger; again and again.");
  }
  return page;
}

std::vector<ListedStimulus> ArcExperiment::training(const StudyRun& run) const {
  return {{"", conditionNamed(run.condition).staircase.start}};
}

std::string ArcExperiment::feedback(const ResponseRecord& response) const {
  // The right answer's words, by ArcQuantity.
  constexpr std::array<const char*, 3> kHad = {"was the smooth one", "had more backlash", "had more delay"};
  return fmt::format("The {} {}; you said {}. {}", response.interval == 1 ? "first" : "second",
                     kHad[static_cast<std::size_t>(study_.quantity)], response.answer,
                     response.correct ? "Right." : "Not this time.");
}

// The arc as a whole cylinder, the blade as it is.
ArcPicture ArcExperiment::pictureOf(const ArcCondition& condition) const {
  constexpr double kHalfWidth = 0.03;  // of what is drawn [m]
  if (!condition.edge)
    return {contact::Cylinder{study_.arc_radius, kHalfWidth},
            {quatFromRotationVector(0.5 * std::numbers::pi * Vec3::UnitY()), Vec3::Zero()}};
  std::vector<Vec3> corners;
  for (const Vec2& p : blade().vertices) {
    for (const double x : {-kHalfWidth, kHalfWidth}) corners.emplace_back(x, p.x(), p.y());
  }
  return {contact::Convex{contact::Polytope::hullOf(corners, "the edge")}, {}};
}

// Up one side and down the other, the body on the left: from the right flank over
// the edge, a sharp corner, to the left one.
contact::Polyline ArcExperiment::blade() const {
  const double half = 0.5 * study_.edge_angle;
  const Vec2 down = kBladeFlank * Vec2(math::sin(half), -math::cos(half));
  return {{down, Vec2::Zero(), Vec2::Zero(), Vec2(-down.x(), down.y())}, false};
}

}  // namespace pincer::tasks
