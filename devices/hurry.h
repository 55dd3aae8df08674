// hurry: a thread that others wait for gets real-time priority, and timers without slack. Without the permission it
// goes on as it is.
#pragma once
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>

namespace pincer::devices {

// Priorities of SCHED_FIFO, 1 .. 99, of which the servo has 80.
inline constexpr int kUsbPriority = 79, kServicePriority = 75, kEmulatorPriority = 70;

inline void hurryThisThread(int priority) noexcept {
  sched_param wanted{};
  wanted.sched_priority = priority;
  ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &wanted);
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

}  // namespace pincer::devices
