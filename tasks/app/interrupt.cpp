#include "pincer/tasks/app/interrupt.h"

#include <csignal>
#include <cstdint>
#include <ctime>

namespace pincer::tasks {
namespace {

// Signals reach nothing but globals.
std::atomic<bool> g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may take no lock");

std::atomic<std::int64_t> g_first_ns{0};  // when the first came; 0: none has
static_assert(std::atomic<std::int64_t>::is_always_lock_free);

constexpr int kEnding[] = {SIGINT, SIGTERM, SIGHUP};  // signals that ask a program to end

// Signals that come so soon after the first are the same wish [ns]: `timeout` and shells signal a program and its
// group. Nobody presses a key twice on purpose as fast.
constexpr std::int64_t kSameWish = 200'000'000;

std::int64_t monotonicNow() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

extern "C" void pincerOnInterrupt(int signal) {
  g_interrupted.store(true);
  const std::int64_t now = monotonicNow();
  std::int64_t first = 0;
  if (g_first_ns.compare_exchange_strong(first, now) || now - first < kSameWish) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // kept back until this returns
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
