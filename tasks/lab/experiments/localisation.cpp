#include "pincer/tasks/lab/experiments/localisation.h"

#include <fmt/format.h>

#include <cmath>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/arc_trial.h"
#include "pincer/tasks/lab/experiments/study_parameters.h"
#include "pincer/tasks/lab/participants/place_observer.h"
#include "pincer/tasks/lab/study/counterbalance.h"

namespace pincer::tasks {
namespace {

constexpr double kReference = 4e-3;    // turn of the cylinder's polygon from segment to segment [rad]: 2e-6 of its radius
constexpr double kTactorReach = 8e-3;  // either way [m]
constexpr std::uint64_t kCylinder = 1, kFeeling = 2, kListOrder = 3;  // parts of seeds

std::string placeName(int place) { return fmt::format("place {}", place + 1); }

// Where the tactor comes from: at least `least` away, on the roomier side, within its reach.
double startPlace(double target, double least, Random& random) {
  const double side = target > 0 || (target == 0 && random.uniform() < 0.5) ? -1 : 1;
  const double room = kTactorReach - side * target;  // on that side
  return target + side * random.uniform(least, room);
}

}  // namespace

void validate(const LocalisationStudy& s) {
  const RangeCheck check("repeated-localisation");
  visitParameters(s, check);
  check("spacing", s.spacing, Parameter{"", {0, 2 * kTactorReach / (s.places - 1), true, "All places lie within 0.016 m."}});
  check("radius_min", s.radius_min, Parameter{"", {0.02, s.radius_max, false, kAsPublished}});
}

LocalisationExperiment::LocalisationExperiment(const LocalisationStudy& study, const ServoOptions& servo, int stride)
    : study_(study), servo_(servo), stride_(stride) {
  validate(study);
}

std::vector<StudyRun> LocalisationExperiment::runs() const {
  std::vector<StudyRun> runs;
  for (int p = 0; p < study_.participants; ++p) {
    StudyRun run{p, 0, "tactor", {}, {}};
    for (int k = 0; k < study_.places; ++k) {
      const double place = (k - 0.5 * (study_.places - 1)) * study_.spacing;
      for (int i = 0; i < study_.repetitions; ++i) run.list.push_back({placeName(k), place});
    }
    Random random(seedFor(seedFor(study_.seed, kListOrder), static_cast<std::uint64_t>(p)));
    shuffle(run.list, random);
    runs.push_back(std::move(run));
  }
  return runs;
}

std::optional<ResponseRecord> LocalisationExperiment::present(const StudyTrial& trial, StudySink& sink,
                                                              const std::atomic<bool>& interrupted, ServoReport& served) {
  Random random(seedFor(trial.seed, kCylinder));
  const double target = trial.stimulus.level, radius = random.uniform(study_.radius_min, study_.radius_max);
  const double start = startPlace(target, study_.least_travel, random);
  PlaceCues cues;
  cues.seed = seedFor(trial.seed, kFeeling);
  cues.radius = radius + study_.finger_radius;
  const Pose X_WD = arcArmBase(cues.radius);
  cues.q_WD = X_WD.q;
  cues.p_WD = X_WD.p;
  cues.from = -start / study_.finger_radius;  // beyond the top the contact is on the proximal side of the pad
  cues.to = -target / study_.finger_radius;
  ArcTrialSetup setup;
  setup.finger_radius = study_.finger_radius;
  setup.path_radius = cues.radius;
  setup.start_angle = cues.from;
  setup.stiffness = study_.stiffness;
  setup.trial = trial.trial;
  setup.stride = stride_;
  const double sweep = 2 * kTactorReach / study_.finger_radius + 0.3;
  const auto curve =
      std::make_shared<const contact::Curve>(contact::arcPolygon(radius, kReference, sweep), contact::SurfaceVariant::smooth);
  setup.intervals = {{{curve, curve, kTactorReach}, {}}};
  PlaceObserver observer(trial.person_seed);
  observer.begin(cues);
  ArcTrial cycle(setup, observer, sink);
  const ServoReport report = runServo(servo_, cycle, interrupted);
  served.add(report);
  if (report.interrupted) return std::nullopt;
  ResponseRecord response;
  response.stimulus = trial.stimulus.name;
  response.level = target;
  response.answer_value = cycle.answered() ? observer.answer() : std::nan("");
  response.answer = fmt::format("{:.1f} mm", 1e3 * response.answer_value);
  response.correct = std::abs(response.answer_value - target) < 0.5 * study_.spacing;
  cycle.measure(response);
  return response;
}

}  // namespace pincer::tasks
