// interrupted: how long work ends early. A signal sets a flag (tasks/app/interrupt.h); what works for long looks at it
// and throws; on the way out destructors remove what isn't whole. What is whole stays.
#pragma once
#include <atomic>
#include <exception>

namespace pincer::tasks {

class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

inline void throwIf(const std::atomic<bool>& interrupted) {
  if (interrupted.load(std::memory_order_relaxed)) throw Interrupted();
}

}  // namespace pincer::tasks
