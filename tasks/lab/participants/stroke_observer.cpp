#include "pincer/tasks/lab/participants/stroke_observer.h"

#include <cmath>

#include "pincer/tasks/lab/participants/reach.h"

namespace pincer::tasks {
namespace {

constexpr double kObserverTick = 1e-3;  // [s]
constexpr double kMiddle = 0.1;         // a stroke's first and last tenth are the turn's, not the surface's

StrokeLimits strokeLimitsOf(StrokeLimits limits, double noise) {
  limits.skin.slow_threshold *= noise;
  limits.skin.quick_threshold *= noise;
  limits.skin.difference *= noise;
  limits.lag_sigma *= noise;
  limits.lag_difference *= noise;
  return limits;
}

}  // namespace

StrokeObserver::StrokeObserver(std::uint64_t seed, const StrokeLimits& limits, const HandRanges& ranges)
    : limits_(strokeLimitsOf(limits, math::exp(limits.sensitivity_spread * Random(seedFor(seed, 1)).normal()))),
      body_(drawBody(ranges, seed)),
      random_(seed),
      roughness_(limits_.skin, limits_.tactor_weight) {}

void StrokeObserver::begin(const StrokeCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  interval_ = 0;
  enter(Phase::kWait);
}

OneFingerAction StrokeObserver::act(const FingerPercept& finger, double time, Cue cue) {
  now_ = time;
  OneFingerAction action;
  if (phase_ == Phase::kWait && cue == Cue::kStart) enter(Phase::kLower);
  feel(finger);
  follow(action);
  return action;
}

void StrokeObserver::enter(Phase phase) {
  phase_ = phase;
  entered_ = now_;
  turning_ = phase == Phase::kStroke;
  if (phase != Phase::kLower) return;
  roughness_.clear();
  stroke_ = turns_ = way_ = 0;
  lags_ = 0;
  returned_ = true;
}

void StrokeObserver::follow(OneFingerAction& action) {
  const double t = now_ - entered_;
  const double pressed = -limits_.press / body_.hands[0].stiffness;
  const double from = (stroke_ % 2 ? 1 : -1) * cues_.half_angle;
  double height = limits_.lift, angle = from;
  switch (phase_) {
    case Phase::kWait:
      break;
    case Phase::kLower:
      height += (pressed - limits_.lift) * minimumJerk(t, limits_.lower_time);
      height_ = pressed;
      if (t >= limits_.lower_time) enter(Phase::kStroke);
      break;
    case Phase::kStroke:
      height_ += kObserverTick * (push_ - limits_.press) / (body_.hands[0].stiffness * limits_.press_time);
      height = height_;
      angle = from * (1 - 2 * minimumJerk(t, strokeTime()));
      if (t < strokeTime()) break;
      ++stroke_;
      enter(stroke_ < cues_.strokes ? Phase::kStroke : Phase::kRaise);
      break;
    case Phase::kRaise:
      height = height_ + (limits_.lift - height_) * minimumJerk(t, limits_.raise_time);
      if (t >= limits_.raise_time) enter(Phase::kRead);
      break;
    case Phase::kRead:
      if (t < limits_.common.reading_time) break;
      readInterval();
      action.interval_over = true;
      enter(interval_ < 2 ? Phase::kWait : Phase::kAnswer);
      stroke_ = 0;
      break;
    case Phase::kAnswer:
      action.answered = t >= limits_.common.reaction_time;
      break;
  }
  action.pull = pullAt(angle, height);
}

void StrokeObserver::feel(const FingerPercept& finger) {
  const double share = (now_ - entered_) / strokeTime();
  const bool counts = phase_ == Phase::kStroke && share > kMiddle && share < 1 - kMiddle;
  const Vec3 f_W = cues_.q_WD * finger.f_D;
  push_ = f_W.norm();
  if (cues_.question == StrokeQuestion::kRougher) roughness_.feelPush({f_W.y(), f_W.z()}, counts);
  if (!finger.tactile.valid || !finger.tactile.place_L) return;
  if (cues_.question == StrokeQuestion::kRougher) roughness_.feelTactor(finger.tactile.place_L->x(), counts);
  if (phase_ == Phase::kStroke) feelTurn(finger.tactile.place_L->x());
}

// At the beginning of each stroke the hand turns; the tactor's turn is felt once it has come back from its farthest place.
void StrokeObserver::feelTurn(double place) {
  if (turning_) {
    turning_ = false;
    way_ = stroke_ == 0 ? 0 : (place > turned_at_ ? 1 : -1);
    turned_at_ = farthest_ = place;
    returned_ = way_ == 0;
    turns_ += way_ != 0;
  }
  if (returned_) return;
  if (way_ * (place - farthest_) > 0) farthest_ = place;
  const double lag = now_ - entered_;
  returned_ = way_ * (farthest_ - place) >= limits_.common.tactor_moves || lag >= strokeTime() - 1.5e-3;
  if (returned_) lags_ += lag;
}

void StrokeObserver::readInterval() {
  const auto interval = static_cast<std::size_t>(interval_++);
  if (cues_.question == StrokeQuestion::kRougher) return roughness_.read(interval, random_);
  const double lag = turns_ > 0 ? lags_ / turns_ : 0;
  felt_lags_[interval] = lag + math::hypot(limits_.lag_sigma, limits_.lag_difference * lag) * random_.normal();
}

int StrokeObserver::compared() const {
  if (cues_.question == StrokeQuestion::kRougher) return roughness_.rougher();
  return felt_lags_[1] > felt_lags_[0] ? 2 : 1;
}

devices::HandPull StrokeObserver::pullAt(double angle, double height) const {
  const Vec3 p_W = cues_.centre_W + (cues_.radius + height) * Vec3(0, math::sin(angle), math::cos(angle));
  devices::HandPull pull = body_.hands[0];
  pull.p_D = cues_.q_WD.conjugate() * (p_W - cues_.p_WD);
  return pull;
}

}  // namespace pincer::tasks
