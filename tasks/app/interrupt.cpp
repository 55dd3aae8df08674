#include "tasks/app/interrupt.h"

#include <csignal>

namespace pincer::tasks {
namespace {

// Signals reach nothing but globals.
std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may take no lock");

extern "C" void pincerOnInterrupt(int signal) {
  g_interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& interruptFlag() {
  static const bool installed = [] {
    std::signal(SIGINT, pincerOnInterrupt);
    std::signal(SIGTERM, pincerOnInterrupt);
    return true;
  }();
  static_cast<void>(installed);
  return g_interrupted;
}

}  // namespace pincer::tasks
