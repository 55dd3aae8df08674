#include "pincer/tasks/lab/participants/stroke_senses.h"

#include <cmath>

namespace pincer::tasks {

void PlaySense::clear() {
  sum_ = 0;
  stops_ = 0;
}

void PlaySense::stop(double finger, double tactor) {
  finger_ = finger;
  tactor_ = tactor;
}

void PlaySense::back(double finger, double tactor, double gain, Random& random) {
  const double way = std::abs(finger - finger_), moved = std::abs(tactor - tactor_);
  const double felt_way = way + limits_.way_sd * random.normal();
  const double felt_move = moved + math::hypot(limits_.place_sd, limits_.difference * moved) * random.normal();
  sum_ += gain * felt_way - felt_move;
  ++stops_;
}

void DelaySense::clear() {
  sum_ = 0;
  strokes_ = 0;
}

void DelaySense::handStarts(double now, double tactor) {
  started_ = first_ = last_ = now;
  mark_ = tactor;
  moved_ = false;
}

void DelaySense::feel(double now, double tactor) {
  if (std::abs(tactor - mark_) < limits_.tactor_moves) return;
  if (!moved_) first_ = now;
  moved_ = true;
  last_ = now;
  mark_ = tactor;
}

void DelaySense::takeStop() { take(last_ - stopped_); }
void DelaySense::takeOnset(double now) { take((moved_ ? first_ : now) - started_); }

void DelaySense::take(double lag) {
  sum_ += lag;
  ++strokes_;
}

void DelaySense::read(std::size_t interval, bool masked, Random& random) {
  const double lag = strokes_ > 0 ? sum_ / strokes_ : 0;
  felt_[interval] =
      lag + (masked ? limits_.masking : 1) * math::hypot(limits_.time_sd, limits_.difference * lag) * random.normal();
}

}  // namespace pincer::tasks
