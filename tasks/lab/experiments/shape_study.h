// shape_study: which of seven solids is it? Shaded or not, with the contact location display or force only.
//
// Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 2: 18 people; two sessions of
// four runs, two with the display, then two without, for every other person the reverse; each run shows all
// 14 models (seven solids, shaded or not) once, shuffled. In a study's file: conditions of one `group` are mixed
// trial by trial, groups follow each other in the order that the file names. Cone and tetrahedron point left or
// right, each once per session and way of rendering. 81.9 % right. A 1-DOF display on a finger of 20 mm radius, as in
// ch. 2's first experiment (ours); friction 0.1 (ours).
#pragma once
#include <array>

#include "pincer/tasks/lab/experiments/shape_trial.h"
#include "pincer/tasks/lab/experiments/solids.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/study/survey.h"

namespace pincer::tasks {

struct ShapeCondition {
  std::string name, label;
  bool shaded = true, display_tactile = true;
  int group = 1;         // of conditions that a run mixes; the lowest comes first where groups are listed
  double published = 0;  // share of right answers; NaN if there is none
};

struct ShapeStudy {
  int participants = 18;
  std::uint64_t seed = 1;
  int sessions = 2;
  SolidSizes sizes;
  double friction = 0.1;        // [-] (ours)
  double finger_radius = 0.02;  // [m] (ours)
  double stiffness = 1000;      // [N/m] (ours)
  double tactor_reach = 8e-3;   // either way [m] (ours)
  bool frozen_tactor = false;   // a control: the tactor is parked in every condition
  bool unrelated = false;       // a control: the model that is felt is drawn, whatever is asked
  std::vector<ShapeCondition> conditions = published();
  SurveyPlan session = oneFingerSurvey();  // what people read, train and are asked

  static std::vector<ShapeCondition> published();
};

void validate(const ShapeStudy& study);

class ShapeExperiment final : public Experiment {
 public:
  ShapeExperiment(const ShapeStudy& study, const ServoOptions& servo, int stride);
  std::vector<StudyRun> runs() const override;
  std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink& sink, const std::atomic<bool>& interrupted,
                                        ServoReport& served) override;
  StudyPage introduction(const StudyRun& run) const override;
  std::vector<ListedStimulus> training(const StudyRun& run) const override;
  std::string feedback(const ResponseRecord& response) const override;
  const SurveyPlan& plan() const override { return study_.session; }
  std::vector<NamedCondition> conditions() const override { return namedOf(study_.conditions); }

 private:
  using Solids = std::array<std::shared_ptr<const contact::SmoothMesh>, kSolids>;

  std::vector<int> groups() const;  // rising
  int runsOfPerson() const;
  StudyRun runOf(int participant, int run, int group) const;
  std::shared_ptr<const contact::SmoothMesh> modelOf(const StudyTrial& trial, const ShapeCondition& condition) const;
  ShapeTrialSetup setupOf(const StudyTrial& trial, const ShapeCondition& condition) const;

  ShapeStudy study_;
  int stride_;
  std::array<std::array<Solids, 2>, 2> solids_;  // not shaded, shaded; pointing right, left
};

}  // namespace pincer::tasks
