// cylinder_trial: one trial of cylinder alignment (hand_trial.h says how a trial goes).
#pragma once
#include "pincer/tasks/lab/experiments/cylinder_alignment.h"
#include "pincer/tasks/lab/experiments/cylinder_judge.h"
#include "pincer/tasks/lab/experiments/hand_trial.h"

namespace pincer::tasks {

class CylinderTrial final : public HandTrial {
 public:
  // Throws InputError for options out of range.
  CylinderTrial(const CylinderAlignmentOptions& options, const CylinderTrialSpec& spec, RecordSink& sink);

  const char* instruction() const override {
    return "Turn the cylinder until its flat faces the monitor; then press Enter";
  }

 private:
  TrialVerdict judge(const HandIntent& intent, double time) override;
  void fill(TrialRecord& row) const override;
  Vec3 truthOf(const HandReading& reading) const override;
  HandGuide taskGuide() const override;
  double timeout() const override { return rules_.timeout; }
  double angle() const;  // of the flat [rad]

  CylinderTrialSpec spec_;
  CylinderRules rules_;
  CylinderJudge judge_;
};

}  // namespace pincer::tasks
