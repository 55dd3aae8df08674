// localisation: how well is a touched place found again? A matching task.
//
//   1  a screen shows the tactor and a target; the finger rolls over a cylinder until the tactor is
//      within 0.25 mm, holds still, memorises; Enter
//   2  the finger is raised; the cylinder's radius and fore-aft place change, so that the tactor has at least 4 mm to
//      travel and the cylinder's centre stays within 50 mm of where it began
//   3  the finger rolls until it feels the same; Enter.   error = match - reference, of the true tactor
//
// Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 3: 5 places 2.8 mm apart, 10 times
// each, cylinders of 50 to 140 mm, first one of 95, a finger of 13 mm; mean absolute error 1.3 mm. `answer` counts
// from the nominal place: nominal + error. The distributions of radius and place are ours, and that the finger,
// which lands on the new cylinder, is led along it.
#pragma once
#include "pincer/tasks/lab/experiments/arc_trial.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/participants/place_observer.h"
#include "pincer/tasks/lab/study/survey.h"

namespace pincer::tasks {

// Which surface the place is found on again, and how the tactor gets there.
struct LocalisationCondition {
  std::string name = "tactor", label = "tactor";
  double radius_min = 0.05, radius_max = 0.14;  // of the second cylinder [m]
  double backlash = 0;                          // added to the display's own [m]
  double delay = 0;                             // likewise [s], of 1 ms cells
  double published = 1.3e-3;                    // mean absolute error [m]; NaN if there is none
};

struct LocalisationStudy {
  int participants = 20;
  std::uint64_t seed = 1;
  int places = 5;
  double spacing = 2.8e-3;       // [m]
  int repetitions = 10;          // of each place
  double least_travel = 4e-3;    // of the tactor [m]
  double base_radius = 0.095;    // of the first cylinder [m]
  double finger_radius = 0.013;  // [m]
  double stiffness = 1000;       // [N/m]
  std::vector<LocalisationCondition> conditions = {{}};
  SurveyPlan session = oneFingerSurvey();  // what people read, train and are asked
};

void validate(const LocalisationStudy& study);

class LocalisationExperiment final : public Experiment {
 public:
  LocalisationExperiment(const LocalisationStudy& study, const ServoOptions& servo, int stride);
  std::vector<StudyRun> runs() const override;
  std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink& sink, const std::atomic<bool>& interrupted,
                                        ServoReport& served) override;
  StudyPage introduction(const StudyRun& run) const override;
  std::vector<ListedStimulus> training(const StudyRun& run) const override;
  std::string feedback(const ResponseRecord& response) const override;
  const SurveyPlan& plan() const override { return study_.session; }
  std::vector<NamedCondition> conditions() const override { return namedOf(study_.conditions); }

 private:
  std::vector<ListedStimulus> places() const;  // of a run, in the row's order
  ArcTrialSetup setupOf(const StudyTrial& trial, const PlaceCues& cues) const;
  PlaceCues cuesOf(const StudyTrial& trial) const;
  const LocalisationCondition& conditionOf(const StudyTrial& trial) const;

  LocalisationStudy study_;
  int stride_;
};

}  // namespace pincer::tasks
