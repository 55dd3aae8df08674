#include "pincer/tasks/lab/experiments/cylinder_judge.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/experiments/cylinder_alignment.h"

namespace pincer::tasks {

TrialVerdict CylinderJudge::observe(const CylinderView& view) {
  PINCER_ASSERT(!begun_ || view.time >= last_time_);
  const double dt = begun_ ? view.time - last_time_ : 0;
  begun_ = true;
  last_time_ = view.time;
  counts_.error = view.error;
  if (view.on_flat) counts_.flat_time += dt;
  watchGrip(view, dt);
  if (view.answers) return TrialVerdict::kSuccess;
  return view.time >= rules_.timeout ? TrialVerdict::kTimeout : TrialVerdict::kRunning;
}

void CylinderJudge::watchGrip(const CylinderView& view, double dt) {
  const double weaker = std::min(view.normal_forces[0], view.normal_forces[1]);
  released_for_ = weaker < 0.5 * rules_.grip_force ? released_for_ + dt : 0;
  if (gripping_ && released_for_ >= rules_.release_time) gripping_ = false;
  if (!gripping_ && weaker > rules_.grip_force) {
    gripping_ = true;
    turned_ = false;
    grip_error_ = view.error;
    ++counts_.grips;
  }
  if (!gripping_ || turned_ || std::abs(wrapAngle(view.error - grip_error_)) <= rules_.turning) return;
  turned_ = true;
  ++counts_.turning_grips;
}

}  // namespace pincer::tasks
