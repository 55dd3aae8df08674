#include "pincer/tasks/lab/participants/place_observer.h"

#include <cmath>

#include "pincer/tasks/lab/participants/reach.h"

namespace pincer::tasks {

PlaceObserver::PlaceObserver(std::uint64_t seed, const PlaceLimits& limits, const HandRanges& ranges)
    : limits_(limits), body_(drawBody(ranges, seed)), random_(seed) {}

void PlaceObserver::begin(const PlaceCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  phase_ = Phase::kWait;
}

OneFingerAction PlaceObserver::act(const FingerPercept& finger, double time, Cue cue) {
  now_ = time;
  if (phase_ == Phase::kWait && cue == Cue::kStart) enter(Phase::kLower);
  const double t = now_ - entered_;
  const double pressed = -limits_.press / body_.hands[0].stiffness;
  const double roll_time = std::abs(cues_.to - cues_.from) * cues_.radius / body_.speed;
  OneFingerAction action;
  double height = pressed, angle = cues_.to;
  switch (phase_) {
    case Phase::kWait:
      height = limits_.lift, angle = cues_.from;
      break;
    case Phase::kLower:
      height = limits_.lift + (pressed - limits_.lift) * minimumJerk(t, limits_.lower_time), angle = cues_.from;
      if (t >= limits_.lower_time) enter(Phase::kRoll);
      break;
    case Phase::kRoll:
      angle = cues_.from + (cues_.to - cues_.from) * minimumJerk(t, roll_time);
      if (t >= roll_time + limits_.common.reading_time) enter(Phase::kRead);  // the tactor, too, comes to rest
      break;
    case Phase::kRead:
      if (t < limits_.common.reading_time) break;
      if (finger.tactile.valid && finger.tactile.place_L)
        felt_ = limits_.common.tactor_bias * finger.tactile.place_L->x() + limits_.common.tactor_sd * random_.normal();
      enter(Phase::kRaise);
      break;
    case Phase::kRaise:
      height = pressed + (limits_.lift - pressed) * minimumJerk(t, limits_.raise_time);
      if (t < limits_.raise_time) break;
      action.interval_over = true;
      enter(Phase::kAnswer);
      break;
    case Phase::kAnswer:
      height = limits_.lift;
      action.answered = t >= limits_.common.reaction_time;
      break;
  }
  action.pull = pullAt(angle, height);
  return action;
}

void PlaceObserver::enter(Phase phase) {
  phase_ = phase;
  entered_ = now_;
}

devices::HandPull PlaceObserver::pullAt(double angle, double height) const {
  const Vec3 p_W = (cues_.radius + height) * Vec3(0, math::sin(angle), math::cos(angle));
  devices::HandPull pull = body_.hands[0];
  pull.p_D = cues_.q_WD.conjugate() * (p_W - cues_.p_WD);
  return pull;
}

}  // namespace pincer::tasks
