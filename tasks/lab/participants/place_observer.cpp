#include "pincer/tasks/lab/participants/place_observer.h"

#include <algorithm>
#include <cmath>

#include "pincer/tasks/lab/participants/reach.h"

namespace pincer::tasks {
namespace {

constexpr double kPlaceTick = 1e-3;  // [s]

}  // namespace

PlaceObserver::PlaceObserver(std::uint64_t seed, const PlaceLimits& limits, const HandRanges& ranges)
    : limits_(limits), body_(drawBody(ranges, seed)), random_(seed) {}

void PlaceObserver::begin(const PlaceCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  interval_ = 0;
  angle_ = path().from;
  phase_ = Phase::kWait;
}

void PlaceObserver::enter(Phase phase) {
  phase_ = phase;
  entered_ = held_ = now_;
}

// One millisecond towards `goal`; returns whether the tactor has been there long enough.
bool PlaceObserver::roll(double place, double goal, double tolerance) {
  const double left = goal - place;
  if (std::abs(left) <= tolerance) return now_ - held_ >= limits_.hold_time;
  held_ = now_;
  // away from the body the contact goes proximally
  const double finger_way = -left * path().radius / cues_.finger_radius;
  const double speed = std::clamp(finger_way / limits_.correction_time, -body_.speed, body_.speed);
  angle_ += kPlaceTick * speed / path().radius;
  return false;
}

void PlaceObserver::remember(double place) {
  const double memory = (1 - limits_.memory_draw) * (place + limits_.reading_sd * random_.normal());
  match_ = std::clamp(memory - limits_.reading_sd * random_.normal(), -cues_.reach, cues_.reach);
}

OneFingerAction PlaceObserver::act(const FingerPercept& finger, double time, Cue cue) {
  now_ = time;
  OneFingerAction action;
  const double t = now_ - entered_;
  if (phase_ == Phase::kWait && cue == Cue::kStart) enter(Phase::kLower);
  if (phase_ == Phase::kLower && t >= limits_.lower_time) enter(Phase::kRoll);
  if (phase_ == Phase::kRoll && finger.tactile.valid && finger.tactile.place_L) {
    const double place = finger.tactile.place_L->x();
    action.enters =
        interval_ == 0 ? roll(place, cues_.target, cues_.tolerance) : roll(place, match_, limits_.match_tolerance);
    if (action.enters && interval_ == 0) remember(place);
    if (action.enters) enter(Phase::kRaise);
  }
  action.pull = pullAt(heightAt(now_ - entered_));
  if (phase_ == Phase::kAnswer) action.answered = t >= limits_.common.reaction_time;
  if (phase_ != Phase::kRaise || t < limits_.raise_time) return action;
  action.interval_over = true;
  const bool last = interval_ == 1;
  enter(last ? Phase::kAnswer : Phase::kWait);
  if (!last) angle_ = cues_.paths[++interval_].from;
  return action;
}

double PlaceObserver::heightAt(double t) const {
  const double pressed = -limits_.press / body_.hands[0].stiffness;
  if (phase_ == Phase::kLower) return limits_.lift + (pressed - limits_.lift) * minimumJerk(t, limits_.lower_time);
  if (phase_ == Phase::kRaise) return pressed + (limits_.lift - pressed) * minimumJerk(t, limits_.raise_time);
  return phase_ == Phase::kRoll ? pressed : limits_.lift;
}

devices::HandPull PlaceObserver::pullAt(double height) const {
  const Vec3 p_W = path().centre_W + (path().radius + height) * Vec3(0, math::sin(angle_), math::cos(angle_));
  devices::HandPull pull = body_.hands[0];
  pull.p_D = cues_.q_WD.conjugate() * (p_W - cues_.p_WD);
  return pull;
}

}  // namespace pincer::tasks
