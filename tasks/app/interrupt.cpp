#include "pincer/tasks/app/interrupt.h"

#include <csignal>

namespace pincer::tasks {
namespace {

// Signals reach nothing but globals.
std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may take no lock");

constexpr int kEnding[] = {SIGINT, SIGTERM, SIGHUP};

extern "C" void pincerOnInterrupt(int) {
  g_interrupted.store(true);
  for (const int signal : kEnding) std::signal(signal, SIG_DFL);
}

bool isIgnored(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

void handleSignals() {
  struct sigaction action {};
  action.sa_handler = pincerOnInterrupt;
  action.sa_flags = SA_RESTART;  // half a write to a pipe would be lost; who waits for a person polls
  for (const int signal : kEnding) {
    if (signal != SIGHUP || !isIgnored(signal)) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

const std::atomic<bool>& interruptFlag() { return g_interrupted; }

}  // namespace pincer::tasks
