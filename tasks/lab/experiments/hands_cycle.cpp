#include "pincer/tasks/lab/experiments/hands_cycle.h"

#include "pincer/tasks/run/measure/timing.h"

namespace pincer::tasks {

bool HandsCycle::tick(double now) { return timed_ ? timedStep(now) : step(now); }

bool HandsCycle::step(double now) {
  hands_.advanceTo(now);
  if (cut_) trial_.cutForces(devices::Trip::kMissedDeadline);
  const double time = hands_.time(now);
  const bool more = trial_.step(hands_.sample(), hands_.intent(), time);
  hands_.apply(trial_.outputs(), trial_.cue(), time);
  return more && hands_.more();
}

bool HandsCycle::timedStep(double now) {
  const double start = steadySeconds();
  hands_.advanceTo(now);
  if (cut_) trial_.cutForces(devices::Trip::kMissedDeadline);
  const std::vector<FingerInputs>& samples = hands_.sample();
  const double sampled = steadySeconds();
  const double time = hands_.time(now);
  const bool more = trial_.step(samples, hands_.intent(), time);
  const double stepped = steadySeconds();
  hands_.apply(trial_.outputs(), trial_.cue(), time);
  samples_.add(sampled - start);
  step_.add(stepped - sampled);
  commands_.add(steadySeconds() - stepped);
  return more && hands_.more();
}

void HandsCycle::cutForces() noexcept {
  cut_ = true;
  hands_.stop();
}

std::vector<StageTimes> HandsCycle::stages() const {
  if (!timed_) return {};
  return {{"samples", samples_}, {"physics, gate", step_}, {"commands", commands_}};
}

}  // namespace pincer::tasks
