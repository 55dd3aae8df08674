// arc_study: the three experiments in which a finger strokes a curve twice and says which time was the comparison, level by staircase.
//
//   smoothness-discrimination  a polygon of `level` radians from segment to segment, against the smooth circle: which was rougher?
//   backlash-discrimination    `level` metres of backlash added to the display's own: when did the tactor come later?
//   delay-discrimination       `level` seconds of delay added: likewise
//
// Source of the designs: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 2 and 3; what they leave open is ours:
//   - C1 .. C4, P1, P2 are read as: C1 facets by force alone; C2 force shading alone; C3 force shading with the tactor on the facets; C4 the
//     same with the tactor on the smooth curve; P1 and P2 the 2D algorithm for the force, without and with the tactor;
//   - the reference of the first is the 2D algorithm on a polygon of a quarter of a degree, 0.24 um off the circle;
//   - the 2-degree edge is a blade of 2 degrees, its tip rounded with a radius of 0.5 mm: the finger goes round it, so that the tactor moves as
//     fast as the finger;
//   - "front end": the place shown is held at two thirds of the tactor's travel, so that its end, where finger and tactor stop, isn't felt;
//   - staircases start well above the published thresholds; smoothness takes steps by ratios; the last 10 reversals of 14 are averaged.
#pragma once
#include <memory>

#include "pincer/tasks/lab/experiments/arc_trial.h"
#include "pincer/tasks/lab/participants/stroke_observer.h"

namespace pincer::tasks {

enum class ArcQuantity : std::uint8_t { kTurn, kBacklash, kDelay };

struct ArcCondition {
  std::string name, label;
  contact::SurfaceVariant force = contact::SurfaceVariant::smooth;
  std::optional<contact::SurfaceVariant> tactile = contact::SurfaceVariant::smooth;  // absent: the tactor is parked
  bool edge = false;                                                                 // the blade in place of the arc
  double travel_share = 1;                                                           // of the tactor's travel that is shown [-]
  StaircaseRule staircase;
  double published = 0;  // threshold, beside which ours is shown; NaN if there is none
};

struct ArcStudy {
  std::string task;
  ArcQuantity quantity = ArcQuantity::kTurn;
  int participants = 12;
  std::uint64_t seed = 1;
  double finger_radius = 0.02;         // [m]
  double arc_radius = 0.1;             // [m]
  double edge_angle = 0.0349066;       // of the blade [rad]
  double edge_radius = 0.5e-3;         // of its tip [m]
  double tactor_reach = 8e-3;          // either way [m]
  double reference_turn = 0.00436332;  // from segment to segment of the smooth circle's polygon [rad]
  double stiffness = 1000;             // of the surface [N/m]
  int strokes = 4;                     // per interval
  std::vector<ArcCondition> conditions;
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

 private:
  const ArcCondition& conditionOf(const StudyTrial& trial) const;
  double pathRadius(const ArcCondition& condition) const;
  StrokeCues cuesOf(const StudyTrial& trial) const;
  ArcTrialSetup setupOf(const StudyTrial& trial, int comparison) const;
  ArcInterval intervalOf(const ArcCondition& condition, double level) const;
  contact::Polyline blade() const;

  ArcStudy study_;
  ServoOptions servo_;
  int stride_;
};

}  // namespace pincer::tasks
