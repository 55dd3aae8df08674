// interrupt: Ctrl-C (SIGINT) and a polite kill (SIGTERM) let the program finish cleanly; a second one ends it at once.
#pragma once
#include <atomic>

namespace pincer::tasks {

// From the first call on the two signals only set this flag; long runs look at it.
const std::atomic<bool>& interruptFlag();

}  // namespace pincer::tasks
