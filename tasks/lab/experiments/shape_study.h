// shape_study: which of seven solids is it? Shaded or not, with the contact location display or force only.
//
// Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 2: 14 models (seven solids, shaded or not), 8 runs in 2 sessions;
// 81.9 % right. Runs with and without the display take turns in an order balanced over participants, sessions are pairs of four runs; each run
// shows each model once, shuffled by the seed (ours).
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
  double published = 0;  // share of right answers; NaN if there is none
};

struct ShapeStudy {
  int participants = 12;
  std::uint64_t seed = 1;
  int runs = 8;  // half of them with the display
  SolidSizes sizes;
  double friction = 0.1;        // [-] (ours)
  double finger_radius = 8e-3;  // [m] (ours)
  double stiffness = 1000;      // [N/m] (ours)
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
  ShapeStudy study_;
  int stride_;
  std::array<std::array<std::shared_ptr<const contact::SmoothMesh>, kSolids>, 2> solids_;  // not shaded, shaded
};

}  // namespace pincer::tasks
