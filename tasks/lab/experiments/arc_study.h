// arc_study: the three experiments in which a finger strokes a curve twice and says which
// time was the comparison, level by staircase.
//
//   smoothness-discrimination  a polygon of `level` radians from segment to segment, against
//                              the exact arc: which was the smooth one?
//   backlash-discrimination    `level` metres of backlash added to the display's own: which had more backlash?
//   delay-discrimination       `level` seconds of delay added: which had more delay?
//
// Strokes go along the finger (fore-aft). Source of the designs: A. J. Doxon, doctoral dissertation, University
// of Utah (2014), ch. 2 and 3. Smoothness:
//
//        force                        tactor
//   C1   facets                       none: held at the middle of the thimble, in both intervals
//   C2   force shading                none
//   C3   facets                       facets
//   C4   facets                       2D algorithm
//   P1   2D algorithm                 2D algorithm       pilots: after C1 .. C4, whose order is a reduced Latin square
//   P2   force shading                facets
//
// Thresholds are counted in segments of the published arc
// (tasks/lab/study/arc_segments.h). What the text leaves open is ours:
//   - the exact arc is the 2D algorithm on a polygon of a quarter of a degree: smooth, 0.24 um off
//     the circle; polygons' vertices lie on it;
//   - the 2-degree edge is a blade whose edge is sharp: contact stays on it, so that the
//     tactor moves as fast as the finger, backwards;
//   - "front end": a sweep begins from rest on one side; where the tactor has come two thirds of its travel from there
//     it freezes until the finger is 10 mm up, so that the onset is felt and the end never;
//   - in the two on the base cylinder the finger may roll, as people do; on the edge and in smoothness it doesn't;
//   - staircases start well above the published thresholds; smoothness takes steps by ratios of the angle.
#pragma once
#include <memory>

#include "pincer/tasks/lab/experiments/arc_trial.h"
#include "pincer/tasks/lab/experiments/study.h"
#include "pincer/tasks/lab/participants/stroke_observer.h"
#include "pincer/tasks/lab/study/survey.h"

namespace pincer::tasks {

enum class ArcQuantity : std::uint8_t { kTurn, kBacklash, kDelay };

struct ArcCondition {
  std::string name, label;
  contact::SurfaceVariant force = contact::SurfaceVariant::smooth;
  std::optional<contact::SurfaceVariant> tactile = contact::SurfaceVariant::smooth;  // absent: the tactor is parked
  bool edge = false;                                                                 // the blade in place of the arc
  double travel_share = 1;  // of a sweep's travel after which the tactor freezes [-]
  StaircaseRule staircase;
  double published = 0;  // threshold, beside which ours is shown [segments, m or s]; NaN if there is none
  bool pilot = false;    // done by everybody, after the others
};

struct ArcStudy {
  std::string task;
  ArcQuantity quantity = ArcQuantity::kTurn;
  int participants = 12;
  std::uint64_t seed = 1;
  double finger_radius = 0.02;         // [m]
  double arc_radius = 0.1;             // [m]
  double edge_angle = 0.0349066;       // of the blade [rad]
  double tactor_reach = 8e-3;          // either way [m]
  double reference_turn = 0.00436332;  // from segment to segment of the exact arc's polygon [rad]
  double stiffness = 1000;             // of the surface [N/m]
  int strokes = 4;                     // per interval
  bool frozen_tactor = false;          // a control: the tactor is parked in every condition
  std::vector<ArcCondition> conditions;
  SurveyPlan session = oneFingerSurvey();  // what people read, train and are asked
};

ArcStudy smoothnessStudy();
ArcStudy backlashStudy();
ArcStudy delayStudy();

// Throws InputError naming the first value out of range, its range and the remedy.
void validate(const ArcStudy& study);

class ArcExperiment final : public Experiment {
 public:
  // `stride`: every stride-th tick is recorded.
  ArcExperiment(const ArcStudy& study, const ServoOptions& servo, int stride);
  std::vector<StudyRun> runs() const override;
  std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink& sink, const std::atomic<bool>& interrupted,
                                        ServoReport& served) override;
  StudyPage introduction(const StudyRun& run) const override;
  std::vector<ListedStimulus> training(const StudyRun& run) const override;
  std::string feedback(const ResponseRecord& response) const override;
  const SurveyPlan& plan() const override { return study_.session; }
  std::vector<NamedCondition> conditions() const override { return namedOf(study_.conditions); }

 private:
  static constexpr double kBeyond = 0.15;  // of the arc's ends over the strokes' [rad]

  const ArcCondition& conditionNamed(const std::string& name) const;
  const ArcCondition& conditionOf(const StudyTrial& trial) const { return conditionNamed(trial.run->condition); }
  ArcPicture pictureOf(const ArcCondition& condition) const;
  double pathRadius(const ArcCondition& condition) const;
  StrokeCues cuesOf(const StudyTrial& trial) const;
  ArcTrialSetup setupOf(const StudyTrial& trial, int comparison, double roll) const;
  ArcInterval intervalOf(const ArcCondition& condition, double level) const;
  contact::Polyline blade() const;
  double sweep() const { return 2 * (study_.tactor_reach / study_.finger_radius + kBeyond); }

  ArcStudy study_;
  int stride_;
  std::shared_ptr<const contact::Curve> arc_, blade_;  // the references
};

}  // namespace pincer::tasks
