// cylinder_judge: the one who sees the world, counts, and says when a trial of cylinder alignment is over.
//
//   grip      both normal forces exceed 0.2 N, until a finger has carried less than half of it for 0.1 s
//   regrasp   a grip that turned the cylinder by more than 3 degrees, after the first such
//   flat      time in which a finger touches the flat
//   success   the participant answers;   timeout: it hasn't (censored data)
// The rules are ours.
#pragma once
#include <array>
#include <cstdint>

#include "pincer/tasks/lab/experiments/trial_verdict.h"

namespace pincer::tasks {

struct CylinderRules {
  double grip_force = 0.2;    // [N]
  double release_time = 0.1;  // [s]
  double turning = 0.0524;    // [rad]
  double timeout = 120;       // [s]
};

struct CylinderView {
  double time = 0;  // since the start tone [s]
  bool answers = false;
  double error = 0;                       // wrap(theta - theta*) [rad]
  std::array<double, 2> normal_forces{};  // [N]
  bool on_flat = false;                   // a finger touches the flat
};

struct CylinderCounts {
  std::int64_t grips = 0, turning_grips = 0;
  double flat_time = 0;  // [s]
  double error = 0;      // the last one [rad]
  std::int64_t regrasps() const { return turning_grips > 0 ? turning_grips - 1 : 0; }
};

class CylinderJudge {
 public:
  explicit CylinderJudge(const CylinderRules& rules = {}) : rules_(rules) {}
  // One tick; time never goes back.
  TrialVerdict observe(const CylinderView& view);
  const CylinderCounts& counts() const { return counts_; }

 private:
  void watchGrip(const CylinderView& view, double dt);

  CylinderRules rules_;
  CylinderCounts counts_;
  double last_time_ = 0;
  bool begun_ = false;
  bool gripping_ = false, turned_ = false;
  double released_for_ = 0;  // [s]
  double grip_error_ = 0;    // when the grip began [rad]
};

}  // namespace pincer::tasks
