#include "pincer/tasks/lab/experiments/pickup_judge.h"

#include <algorithm>
#include <cmath>

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

double gripOf(const PickupView& view) { return 0.5 * (view.fingers[0].normal_force + view.fingers[1].normal_force); }

double weakerOf(const PickupView& view) { return std::min(view.fingers[0].normal_force, view.fingers[1].normal_force); }

double offsetFromLine(const PickupView& view) {
  const Vec3 line_W = view.fingers[1].p_WC - view.fingers[0].p_WC;
  const Vec3 centre_W = view.p_WBcm - view.fingers[0].p_WC;
  const double length = line_W.norm();
  return length > 0 ? centre_W.cross(line_W).norm() / length : centre_W.norm();
}

}  // namespace

TrialVerdict PickupJudge::observe(const PickupView& view) {
  PINCER_ASSERT(!begun_ || view.time >= last_time_);
  const double dt = begun_ ? view.time - last_time_ : 0;
  begun_ = true;
  last_time_ = view.time;
  counts_.peak_grip = std::max(counts_.peak_grip, gripOf(view));
  watchHeight(view);
  watchSqueeze(view, dt);
  watchSlip(view, dt);
  return watchHold(view, dt);
}

void PickupJudge::watchSqueeze(const PickupView& view, double dt) {
  released_for_ = weakerOf(view) < 0.5 * rules_.squeeze_force ? released_for_ + dt : 0;
  highest_ = std::max(highest_, view.clearance);
  if (squeezing_ && (!view.wants_lift || released_for_ >= rules_.release_time)) {
    squeezing_ = false;
    judgeFailure(view);
  }
  if (squeezing_ || !view.wants_lift || weakerOf(view) <= rules_.squeeze_force) return;
  squeezing_ = true;
  ++counts_.squeezes;
  counts_.offset_at_squeeze = offsetFromLine(view);
  highest_ = view.clearance;
  dropped_in_squeeze_ = false;
  p_squeeze_W_ = view.p_WBcm;
}

void PickupJudge::judgeFailure(const PickupView& view) {
  const bool aside = std::abs(view.p_WBcm.y() - p_squeeze_W_.y()) > rules_.aside;
  ++counts_.failures;
  counts_.last_failure = dropped_in_squeeze_                ? "dropped"
                         : aside                            ? "squeezed out"
                         : highest_ <= rules_.off_clearance ? "not lifted"
                                                            : "slipped";
}

void PickupJudge::watchHeight(const PickupView& view) {
  if (!off_ && view.clearance > rules_.off_clearance) {
    off_ = true;
    ++counts_.lifts;
  }
  if (!off_) return;
  const bool touched = view.fingers[0].on_object || view.fingers[1].on_object;
  if (!cleared_ && view.clearance > rules_.try_clearance) {
    cleared_ = true;
    ++counts_.tries_5mm;
  }
  held_ = held_ || (cleared_ && touched);
  if (held_ && !touched && !dropped_) {
    dropped_ = dropped_in_squeeze_ = true;
    ++counts_.drops;
  }
  if (view.clearance > rules_.back_clearance) return;
  off_ = cleared_ = held_ = dropped_ = false;
}

void PickupJudge::watchSlip(const PickupView& view, double dt) {
  for (std::size_t i = 0; i < view.fingers.size(); ++i) {
    const auto& finger = view.fingers[i];
    Slide& slide = slides_[i];
    if (!finger.on_object || finger.normal_force <= rules_.loaded_force) {
      slide = Slide();
      continue;
    }
    slide.stuck_for = finger.sliding ? 0 : slide.stuck_for + dt;
    if (slide.stuck_for >= rules_.stick_time) slide = {0, slide.stuck_for, true, false};
    if (finger.sliding) slide.distance += finger.slide_speed * dt;
    if (!slide.stuck || slide.counted || slide.distance < rules_.slip_distance) continue;
    slide.counted = true;
    ++counts_.slips;
  }
}

TrialVerdict PickupJudge::watchHold(const PickupView& view, double dt) {
  if (view.clearance < rules_.success_height) {
    over_since_ = -1;
    grip_time_ = grip_integral_ = 0;
  } else {
    if (over_since_ < 0) over_since_ = view.time;
    grip_time_ += dt;
    grip_integral_ += gripOf(view) * dt;
    if (view.time - over_since_ >= rules_.hold_time) {
      counts_.held_grip = grip_time_ > 0 ? grip_integral_ / grip_time_ : gripOf(view);
      return TrialVerdict::kSuccess;
    }
  }
  return view.time >= rules_.timeout ? TrialVerdict::kTimeout : TrialVerdict::kRunning;
}

}  // namespace pincer::tasks
