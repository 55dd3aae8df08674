// pickup_trial: one trial of sphere pickup (hand_trial.h says how a trial goes).
#pragma once
#include "pincer/tasks/lab/experiments/hand_trial.h"
#include "pincer/tasks/lab/experiments/pickup_judge.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"

namespace pincer::tasks {

class PickupTrial final : public HandTrial {
 public:
  PickupTrial(const SpherePickupOptions& options, const PickupObject& object, const PickupTrialSpec& spec,
              RecordSink& sink);

  const char* instruction() const override { return "Pinch the object, lift it by 50 mm and hold it for a second"; }

 private:
  TrialVerdict judge(const HandIntent& intent, double time) override;
  void fill(TrialRecord& row) const override;
  Vec3 truthOf(const HandReading& reading) const override;
  HandGuide taskGuide() const override;
  double timeout() const override { return rules_.timeout; }

  void noteCounts(const PickupCounts& before);
  PickupView view(bool wants_lift, double time);

  PickupTrialSpec spec_;
  double smallest_grip_;  // m g / (2 mu_s) [N]
  PickupRules rules_;
  PickupJudge judge_;
  double clearance_ = 0;  // of the object over the dish, this tick [m]
  contact::PatchCacheHandle patches_ = contact::makePatchCache(64);
  double felt_grip_ = 0, true_grip_ = 0;  // at the last reading of the grip [N]
};

}  // namespace pincer::tasks
