#include "pincer/tasks/lab/experiments/localisation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pincer/contact/error.h"
#include "pincer/contact/io/printable.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/study/counterbalance.h"

namespace pincer::tasks {
namespace {

constexpr double kReference = 4e-3;  // turn of the cylinder's polygon from segment to segment [rad]: 2e-6 of its radius
constexpr double kTactorReach = 8e-3;                                 // either way [m]
constexpr double kFarthestCentre = 0.05;                              // of a cylinder from where it began [m]
constexpr double kArcBeyond = 0.3;                                    // of the arc over what the tactor can show [rad]
constexpr std::uint64_t kCylinder = 1, kFeeling = 2, kListOrder = 3;  // parts of seeds

std::string placeName(int place) { return fmt::format("place {}", place + 1); }

// A place at least `least` away, on the roomier side, within the tactor's reach.
double startPlace(double target, double least, Random& random) {
  const double side = target > 0 || (target == 0 && random.uniform() < 0.5) ? -1 : 1;
  const double room = kTactorReach - side * target;  // on that side
  return target + side * random.uniform(least, room);
}

// The cylinder `radius` whose top is as high as the first one's, under a finger at
// `finger_y` that touches it with `place`.
PlacePath secondPath(double finger_y, double base_radius, double radius, double place, double finger_radius) {
  PlacePath path;
  path.radius = radius + finger_radius;
  path.from = -place / finger_radius;
  path.centre_W = {0, finger_y - path.radius * math::sin(path.from), base_radius - radius};
  return path;
}

contact::Polyline movedArc(double radius, double sweep, const Vec3& centre_W) {
  contact::Polyline arc = contact::arcPolygon(radius, kReference, sweep);
  for (Vec2& p : arc.vertices) p += Vec2(centre_W.y(), centre_W.z());
  return arc;
}

}  // namespace

void validate(const LocalisationStudy& s) {
  const RangeCheck check("repeated-localisation");
  visitParameters(s, check);
  visitParameters(s.session, RangeCheck("repeated-localisation: session", "session"));
  validate(s.session, "repeated-localisation");
  check("spacing", s.spacing,
        Parameter{"", {0, 2 * kTactorReach / (s.places - 1), true, "All places lie within 0.016 m."}});
  requireNamed(s.conditions, "repeated-localisation");
  for (std::size_t k = 0; k < s.conditions.size(); ++k) {
    const LocalisationCondition& c = s.conditions[k];
    const std::string of = fmt::format("repeated-localisation: condition {}", printable(c.name)),
                      path = fmt::format("conditions[{}]", k);
    const RangeCheck check_condition(of, path);
    visitParameters(c, check_condition);
    check_condition("radius_min", c.radius_min, Parameter{"", {0.02, c.radius_max, false, kAsPublished}});
  }
}

LocalisationExperiment::LocalisationExperiment(const LocalisationStudy& study, const ServoOptions& servo, int stride)
    : Experiment(servo), study_(study), stride_(stride) {
  validate(study);
}

std::vector<StudyRun> LocalisationExperiment::runs() const {
  std::vector<StudyRun> runs;
  for (int p = 0; p < study_.participants; ++p) {
    const std::uint64_t person_seed = seedFor(seedFor(study_.seed, kListOrder), static_cast<std::uint64_t>(p));
    std::int64_t place = 0;
    for (int block = 0; block < study_.session.blocks; ++block) {
      for (const int c : conditionOrder(study_.session.order, study_.conditions.size(), p, block, study_.seed)) {
        StudyRun run{p, place, study_.conditions[static_cast<std::size_t>(c)].name, {}, places()};
        Random random(place == 0 ? person_seed : seedFor(person_seed, static_cast<std::uint64_t>(place)));
        shuffle(run.list, random);
        runs.push_back(std::move(run));
        ++place;
      }
    }
  }
  return runs;
}

std::vector<ListedStimulus> LocalisationExperiment::places() const {
  std::vector<ListedStimulus> list;
  for (int k = 0; k < study_.places; ++k) {
    const double place = (k - 0.5 * (study_.places - 1)) * study_.spacing;
    for (int i = 0; i < study_.repetitions; ++i) list.push_back({placeName(k), place});
  }
  return list;
}

const LocalisationCondition& LocalisationExperiment::conditionOf(const StudyTrial& trial) const {
  return *std::find_if(study_.conditions.begin(), study_.conditions.end(),
                       [&](const LocalisationCondition& c) { return c.name == trial.run->condition; });
}

std::optional<ResponseRecord> LocalisationExperiment::present(const StudyTrial& trial, StudySink& sink,
                                                              const std::atomic<bool>& interrupted,
                                                              ServoReport& served) {
  const double target = trial.stimulus.level;
  const PlaceCues cues = cuesOf(trial);
  const ArcTrialSetup setup = setupOf(trial, cues);
  PlaceObserver observer(trial.person_seed);
  observer.begin(cues);
  const auto finger = wornBy(arcPlace(setup), observer);
  ArcTrial cycle(setup, *finger, sink);
  if (!serve(cycle, trial, interrupted, served)) return std::nullopt;
  ResponseRecord response;
  response.stimulus = trial.stimulus.name;
  response.level = target;
  const std::vector<double>& places = cycle.enteredPlaces();
  response.answer_value = cycle.answered() && places.size() == 2 ? target + places[1] - places[0] : std::nan("");
  response.answer = fmt::format("{:.1f} mm", 1e3 * response.answer_value);
  response.correct = std::abs(response.answer_value - target) < 0.5 * study_.spacing;
  cycle.measure(response);
  return response;
}

ArcTrialSetup LocalisationExperiment::setupOf(const StudyTrial& trial, const PlaceCues& cues) const {
  constexpr double kHalfWidth = 0.03;  // of the cylinders that are drawn [m]
  ArcTrialSetup setup;
  setup.finger_radius = study_.finger_radius;
  setup.path_radius = cues.paths[0].radius;
  setup.start_angle = cues.paths[0].from;
  setup.stiffness = study_.stiffness;
  setup.asked.trial = trial.trial;
  setup.asked.stride = stride_;
  setup.asked.question = TrialQuestion::kMatch;
  setup.asked.target = cues.target;
  setup.asked.tolerance = cues.tolerance;
  setup.asked.training = trial.training;
  setup.asked.texts.feel = "Move along the finger until it is the place to keep; hold still and press Enter";
  const double sweep = 2 * kTactorReach / study_.finger_radius + kArcBeyond;
  devices::VirtualTransmission transmission;
  transmission.backlash = conditionOf(trial).backlash;
  transmission.delay = static_cast<int>(std::lround(1000 * conditionOf(trial).delay));
  const Quat across = quatFromRotationVector(0.5 * std::numbers::pi * Vec3::UnitY());
  for (const PlacePath& path : cues.paths) {
    const double radius = path.radius - study_.finger_radius;
    const auto curve =
        std::make_shared<const contact::Curve>(movedArc(radius, sweep, path.centre_W), contact::SurfaceVariant::smooth);
    setup.intervals.push_back(
        {{curve, curve, kTactorReach}, transmission, {contact::Cylinder{radius, kHalfWidth}, {across, path.centre_W}}});
  }
  return setup;
}

StudyPage LocalisationExperiment::introduction(const StudyRun&) const {
  return {"Where does it feel the same?",
          {"The screen shows where the tactor touches your fingerpad, and a ring. Touch the surface and move fore and "
           "aft until the tactor is in the ring.",
           "Hold still, keep the place in mind and press Enter. Then raise the finger: the surface changes.",
           "After the tone touch again and move until it feels the same on your fingerpad. Then press Enter."}};
}

std::vector<ListedStimulus> LocalisationExperiment::training(const StudyRun& run) const { return {run.list.front()}; }

std::string LocalisationExperiment::feedback(const ResponseRecord& response) const {
  return fmt::format("You were {:.1f} mm off the place.", 1e3 * std::abs(response.answer_value - response.level));
}

PlaceCues LocalisationExperiment::cuesOf(const StudyTrial& trial) const {
  constexpr int kMostDraws = 1000;  // until a second cylinder is within kFarthestCentre; bounds the search, chosen
  Random random(seedFor(trial.seed, kCylinder));
  const LocalisationCondition& condition = conditionOf(trial);
  PlaceCues cues;
  cues.seed = seedFor(trial.seed, kFeeling);
  cues.target = trial.stimulus.level;
  cues.finger_radius = study_.finger_radius;
  cues.reach = kTactorReach;
  cues.paths[0].radius = study_.base_radius + study_.finger_radius;
  cues.paths[0].from = -startPlace(cues.target, study_.least_travel, random) / study_.finger_radius;
  const Pose X_WD = arcArmBase(cues.paths[0].radius);
  cues.q_WD = X_WD.q;
  cues.p_WD = X_WD.p;
  const double finger_y = cues.paths[0].radius * math::sin(-cues.target / study_.finger_radius);
  for (int k = 0; k < kMostDraws; ++k) {
    const double radius = random.uniform(condition.radius_min, condition.radius_max);
    const double place = startPlace(cues.target, study_.least_travel, random);
    cues.paths[1] = secondPath(finger_y, study_.base_radius, radius, place, study_.finger_radius);
    if (std::abs(cues.paths[1].centre_W.y()) <= kFarthestCentre) break;
  }
  return cues;
}

}  // namespace pincer::tasks
