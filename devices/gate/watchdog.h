// watchdog: zero force, latched, when the servo loop stops feeding it.
//
//   expired  <=>  now - fed > limit at a check; from then on until arm() is called
//
// The servo thread feeds after every finished tick and asks expired() before it commands a force; a second thread
// checks, at least four times per limit, and on expiry commands zero force itself. feed(), check() and expired() take
// no lock and never block. Time is the caller's monotonic clock in nanoseconds, so a test brings its own. A stalled
// servo that wakes up after the expiry sees the latch: what it was about to send may still reach the motor once, in the
// moment between its question and its command.
#pragma once
#include <atomic>
#include <cstdint>

namespace pincer::devices {

class Watchdog {
 public:
  // `limit_ns` > 0: how long the loop may be silent.
  explicit Watchdog(std::int64_t limit_ns) : limit_ns_(limit_ns) {}

  // Clears the latch and starts to wait for food.
  void arm(std::int64_t now_ns);
  // Stops waiting: nothing expires until the next arm(). Doesn't clear the latch.
  void rest();
  // The loop is alive. Never clears the latch.
  void feed(std::int64_t now_ns);
  // From the second thread. True once, at the check that finds the loop silent: the caller commands zero force.
  bool check(std::int64_t now_ns);
  // True if the latch is set: no force but zero may be commanded.
  bool expired() const { return expired_.load(std::memory_order_acquire); }

 private:
  const std::int64_t limit_ns_;
  std::atomic<std::int64_t> fed_ns_{0};
  std::atomic<bool> waiting_{false};
  std::atomic<bool> expired_{false};
};

}  // namespace pincer::devices
