#include "pincer/devices/gate/watchdog.h"

namespace pincer::devices {

void Watchdog::arm(std::int64_t now_ns) {
  fed_ns_.store(now_ns, std::memory_order_relaxed);
  expired_.store(false, std::memory_order_relaxed);
  waiting_.store(true, std::memory_order_release);
}

void Watchdog::rest() { waiting_.store(false, std::memory_order_release); }

void Watchdog::feed(std::int64_t now_ns) { fed_ns_.store(now_ns, std::memory_order_release); }

bool Watchdog::check(std::int64_t now_ns) {
  if (!waiting_.load(std::memory_order_acquire)) return false;
  if (now_ns - fed_ns_.load(std::memory_order_acquire) <= limit_ns_) return false;
  return !expired_.exchange(true, std::memory_order_acq_rel);
}

}  // namespace pincer::devices
