// localisation: where on the fingerpad is the tactor? It goes to one of a few places, and the participant names the place felt.
//
// The finger rests on a cylinder whose radius changes from trial to trial, so that the hand's posture doesn't tell the place; the contact runs
// from a place at least `least_travel` away to the target, as the finger rolls over the cylinder.
// Source: A. J. Doxon, doctoral dissertation, University of Utah (2014), ch. 3: 5 places 2.8 mm apart, 10 times each, cylinders of 50 to
// 140 mm, a travel of at least 4 mm; mean absolute error 1.3 mm, bias towards the centre. Participants name the place on a continuous scale
// (ours). The simulated participant's limit is taken from this very experiment: the study shows what display and protocol add to it.
#pragma once
#include "pincer/tasks/lab/experiments/study.h"

namespace pincer::tasks {

struct LocalisationStudy {
  int participants = 20;
  std::uint64_t seed = 1;
  int places = 5;
  double spacing = 2.8e-3;                      // [m]
  int repetitions = 10;                         // of each place
  double least_travel = 4e-3;                   // of the tactor [m]
  double radius_min = 0.05, radius_max = 0.14;  // of the cylinders [m]
  double finger_radius = 0.02;                  // [m]
  double stiffness = 1000;                      // [N/m]
  double published_error = 1.3e-3;              // mean absolute [m]
};

void validate(const LocalisationStudy& study);

class LocalisationExperiment final : public Experiment {
 public:
  LocalisationExperiment(const LocalisationStudy& study, const ServoOptions& servo, int stride);
  std::vector<StudyRun> runs() const override;
  std::optional<ResponseRecord> present(const StudyTrial& trial, StudySink& sink, const std::atomic<bool>& interrupted,
                                        ServoReport& served) override;

 private:
  LocalisationStudy study_;
  ServoOptions servo_;
  int stride_;
};

}  // namespace pincer::tasks
