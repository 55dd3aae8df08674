#include "pincer/tasks/lab/participants/stroke_observer.h"

#include <algorithm>
#include <cmath>

#include "pincer/tasks/lab/participants/reach.h"

namespace pincer::tasks {
namespace {

constexpr double kObserverTick = 1e-3;   // [s]
constexpr double kMiddle = 0.1;          // a stroke's first and last tenth are the turn's, not the surface's
constexpr double kIsochronousWay = 0.1;  // [m]
constexpr std::uint64_t kSensitivity = 1, kWays = 2;  // parts of a person's seed

StrokeLimits strokeLimitsOf(StrokeLimits limits, double noise) {
  limits.skin.slow_threshold *= noise;
  limits.skin.quick_threshold *= noise;
  limits.skin.difference *= noise;
  limits.lag.way_sd *= noise;
  limits.lag.place_sd *= noise;
  limits.lag.time_sd *= noise;
  limits.lag.difference *= noise;
  return limits;
}

// Way from 0 to 1 in the time `whole`, at even speed but for ramps of `ramp`, 2 ramp <= whole.
double evenWay(double t, double whole, double ramp) {
  const double v = 1 / (whole - ramp), x = std::clamp(t, 0.0, whole);
  if (x < ramp) return 0.5 * v * x * x / ramp;
  return x < whole - ramp ? v * (x - 0.5 * ramp) : 1 - 0.5 * v * (whole - x) * (whole - x) / ramp;
}

}  // namespace

StrokeObserver::StrokeObserver(std::uint64_t seed, const StrokeLimits& limits, const HandRanges& ranges)
    : limits_(
          strokeLimitsOf(limits, math::exp(limits.sensitivity_spread * Random(seedFor(seed, kSensitivity)).normal()))),
      body_(drawBody(ranges, seed)),
      random_(seed),
      roughness_(limits_.skin, limits_.tactor_weight),
      play_(limits_.lag),
      delay_(limits_.lag) {
  Random ways(seedFor(seed, kWays));
  roll_ = ways.uniform(limits.roll_min, limits.roll_max);
  probe_ = ways.uniform(limits.probe_min, limits.probe_max);
}

void StrokeObserver::begin(const StrokeCues& cues) {
  cues_ = cues;
  random_ = Random(cues.seed);
  interval_ = stroke_ = 0;
  from_ = to_ = -halfAngle();
  enter(Phase::kWait);
}

int StrokeObserver::answer() const {
  if (cues_.question == StrokeQuestion::kRougher) return roughness_.rougher();
  return cues_.question == StrokeQuestion::kLooser ? play_.larger() : delay_.larger();
}

OneFingerAction StrokeObserver::act(const FingerPercept& finger, double time, Cue cue) {
  now_ = time;
  OneFingerAction action;
  if (phase_ == Phase::kWait && cue == Cue::kStart) {
    roughness_.clear();
    play_.clear();
    delay_.clear();
    enter(Phase::kLower);
  }
  feel(finger);
  follow(action);
  if (cues_.rolls) action.pitch = roll_ * angleAt(now_ - entered_);
  return action;
}

void StrokeObserver::enter(Phase phase) {
  phase_ = phase;
  entered_ = now_;
}

double StrokeObserver::timeFor(double angle) const {
  const double way = std::abs(angle) * cues_.radius;
  return std::max(2 * limits_.ramp_time, std::sqrt(way * kIsochronousWay) / body_.speed);
}

void StrokeObserver::setOut(double to, double way_time) {
  from_ = to_;
  to_ = to;
  way_time_ = way_time;
}

void StrokeObserver::startStroke() {
  const double to = stroke_ % 2 ? -halfAngle() : halfAngle();
  setOut(to, timeFor(to - to_));
  delay_.handStarts(now_, tactor_);
  enter(Phase::kStroke);
}

// The next stroke, or the end of the interval.
void StrokeObserver::next() {
  ++stroke_;
  stroke_ < cues_.strokes ? startStroke() : enter(Phase::kRaise);
}

bool StrokeObserver::phaseOver(double t) const {
  switch (phase_) {
    case Phase::kWait:
      return false;
    case Phase::kLower:
      return t >= limits_.lower_time;
    case Phase::kTouch:
    case Phase::kStopped:
    case Phase::kBack:
      return t >= limits_.rest_time;
    case Phase::kStroke:
    case Phase::kProbe:
      return t >= way_time_;
    case Phase::kRaise:
      return t >= limits_.raise_time;
    case Phase::kRead:
      return t >= limits_.common.reading_time;
    case Phase::kAnswer:
      return t >= limits_.common.reaction_time;
  }
  return false;
}

void StrokeObserver::endStroke() {
  delay_.handStops(now_);
  if (cues_.question == StrokeQuestion::kRougher) return next();
  if (cues_.question != StrokeQuestion::kOnset) return enter(Phase::kStopped);
  delay_.takeOnset(now_);
  ++stroke_;
  enter(Phase::kRaise);
}

void StrokeObserver::endStop() {
  if (cues_.question == StrokeQuestion::kLater) {
    delay_.takeStop();
    return next();
  }
  play_.stop(finger_, tactor_);
  const double back = probe_ / cues_.radius;
  setOut(to_ - std::copysign(back, to_), timeFor(back));
  enter(Phase::kProbe);
}

void StrokeObserver::endReading(OneFingerAction& action) {
  readInterval();
  action.interval_over = true;
  from_ = to_ = -halfAngle();
  stroke_ = 0;
  enter(interval_ < 2 ? Phase::kWait : Phase::kAnswer);
}

void StrokeObserver::endPhase(OneFingerAction& action) {
  const bool onset = cues_.question == StrokeQuestion::kOnset;
  switch (phase_) {
    case Phase::kWait:
      break;
    case Phase::kLower:
      return onset ? enter(Phase::kTouch) : startStroke();
    case Phase::kTouch:
      return startStroke();
    case Phase::kStroke:
      return endStroke();
    case Phase::kStopped:
      return endStop();
    case Phase::kProbe:
      return enter(Phase::kBack);
    case Phase::kBack:
      play_.back(finger_, tactor_, cues_.tactor_gain * (1 + roll()), random_);
      return next();
    case Phase::kRaise:
      return enter(onset && stroke_ < cues_.strokes ? Phase::kLower : Phase::kRead);
    case Phase::kRead:
      return endReading(action);
    case Phase::kAnswer:
      action.answered = true;
  }
}

void StrokeObserver::follow(OneFingerAction& action) {
  const double t = now_ - entered_;
  action.pull = pullAt(angleAt(t), heightAt(t));
  if (phaseOver(t)) endPhase(action);
}

double StrokeObserver::angleAt(double t) const {
  if (phase_ != Phase::kStroke && phase_ != Phase::kProbe) return to_;
  const bool even = cues_.question == StrokeQuestion::kLater || cues_.question == StrokeQuestion::kOnset;
  return from_ + (to_ - from_) * (even ? evenWay(t, way_time_, limits_.ramp_time) : minimumJerk(t, way_time_));
}

double StrokeObserver::heightAt(double t) {
  const double stiffness = body_.hands[0].stiffness, pressed = -limits_.press / stiffness;
  if (phase_ == Phase::kLower) {
    height_ = pressed;
    return limits_.lift + (pressed - limits_.lift) * minimumJerk(t, limits_.lower_time);
  }
  if (isTouching()) return height_ += kObserverTick * (push_ - limits_.press) / (stiffness * limits_.press_time);
  if (phase_ == Phase::kRaise) return height_ + (limits_.lift - height_) * minimumJerk(t, limits_.raise_time);
  return limits_.lift;
}

void StrokeObserver::feel(const FingerPercept& finger) {
  const bool rougher = cues_.question == StrokeQuestion::kRougher;
  const double share = (now_ - entered_) / way_time_;
  const bool counts = phase_ == Phase::kStroke && share > kMiddle && share < 1 - kMiddle;
  const Vec3 f_W = cues_.q_WD * finger.f_D;
  push_ = f_W.norm();
  if (rougher) roughness_.feelPush({f_W.y(), f_W.z()}, counts);
  if (!finger.tactile.valid || !finger.tactile.place_L) return;
  tactor_ = finger.tactile.place_L->x();
  if (rougher) return roughness_.feelTactor(tactor_, counts);
  if (cues_.question == StrokeQuestion::kLooser && (phase_ == Phase::kStopped || phase_ == Phase::kBack)) {
    const Vec3 p_W = cues_.q_WD * finger.arm.p_DF + cues_.p_WD - cues_.centre_W;
    finger_ = cues_.radius * math::atan2(p_W.y(), p_W.z());
  }
  if (phase_ == Phase::kStroke || phase_ == Phase::kStopped) delay_.feel(now_, tactor_);
}

void StrokeObserver::readInterval() {
  const auto interval = static_cast<std::size_t>(interval_++);
  switch (cues_.question) {
    case StrokeQuestion::kRougher:
      return roughness_.read(interval, random_);
    case StrokeQuestion::kLooser:
      return play_.read(interval);
    case StrokeQuestion::kLater:
    case StrokeQuestion::kOnset:
      return delay_.read(interval, cues_.question == StrokeQuestion::kOnset, random_);
  }
}

devices::HandPull StrokeObserver::pullAt(double angle, double height) const {
  const Vec3 p_W = cues_.centre_W + (cues_.radius + height) * Vec3(0, math::sin(angle), math::cos(angle));
  devices::HandPull pull = body_.hands[0];
  pull.p_D = cues_.q_WD.conjugate() * (p_W - cues_.p_WD);
  return pull;
}

}  // namespace pincer::tasks
