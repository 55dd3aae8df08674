// paced_cycle: lets somebody who watches pause a cycle, take single ticks and slow it down. The inner cycle
// has its own time, which only its ticks move; it can't tell that it is held. Not for devices that render
// forces to a person: those need every tick.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>

#include "pincer/contact/assert.h"
#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {

// Set by one thread, read by the servo's.
struct PaceControl {
  std::atomic<bool> paused{false};
  std::atomic<int> single_ticks{0};  // to do while paused
  std::atomic<double> speed{1};      // of the inner time, 0 .. 8; over 1 several ticks are done at a time
  std::atomic<bool> stop{false};     // ends the cycle
  std::atomic<bool> ended{false};    // told by the servo: the cycle is over
  std::atomic<bool> linger{false};   // a cycle that is over goes on without ticks, to be looked at
  // told by the servo: how late the last tick began, against the one before [s]; negative: none yet
  std::atomic<double> late{-1};
};

class PacedCycle final : public ServoCycle {
 public:
  // `rate` of the inner ticks [Hz]; both must outlive this.
  PacedCycle(ServoCycle& inner, PaceControl& control, double rate) : inner_(inner), control_(control), rate_(rate) {
    PINCER_ASSERT(rate > 0);
  }

  bool tick(double) override {
    if (control_.stop) return false;
    noteLateness();
    if (!more_) return control_.linger;
    if (control_.paused) {
      owed_ = 0;
      if (control_.single_ticks.load() > 0) {
        control_.single_ticks.fetch_sub(1);
        more_ = once();
      }
      return true;
    }
    for (owed_ += control_.speed; owed_ >= 1 && more_; owed_ -= 1) more_ = once();
    return true;
  }
  void cutForces() noexcept override { inner_.cutForces(); }

 private:
  void noteLateness() {
    const double clock = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    if (before_ != 0) control_.late = std::max(clock - before_ - 1 / rate_, 0.0);
    before_ = clock;
  }
  bool once() {
    const bool more = inner_.tick(static_cast<double>(ticks_++) / rate_);
    if (!more) control_.ended = true;
    return more;
  }

  ServoCycle& inner_;
  PaceControl& control_;
  double rate_;
  double before_ = 0;  // when the last tick began, on the clock [s]
  double owed_ = 0;    // inner ticks
  long ticks_ = 0;
  bool more_ = true;
};

}  // namespace pincer::tasks
