// The program ends while an Inverse3 pushes: by a signal, asked for or not, the last word is
// zero. The service keeps forces for ever.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/tests/support/spawned.h"

namespace pincer::tests {
namespace {

using devices::emulate::DeadMan;
using devices::emulate::HaplyServer;

devices::emulate::HaplyServiceSettings settingsThat(DeadMan dead_man) {
  devices::emulate::HaplyServiceSettings settings;
  for (auto& arm : settings.arms) arm.dead_man = dead_man, arm.idle_after = 0.05;
  return settings;
}

// The force that is left half a second after `signal` came while the arm pushed [N]; negative: it never pushed.
double forceAfter(int signal, DeadMan dead_man) {
  HaplyServer server(settingsThat(dead_man));
  double left = -1;
  spawnPincer({"devices", "test", "049D", "--devices", "haply", "--force", "0.3", "--yes", "--watchdog", "100",
               "--service", server.place()},
              {.meanwhile = [&](pid_t pid) {
                bool pushed = false;
                for (int i = 0; i < 5000 && !pushed; ++i) {
                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                  pushed = server.force(0) > 0.1;
                }
                ::kill(pid, signal);
                std::this_thread::sleep_for(std::chrono::milliseconds(500));
                left = pushed ? server.force(0) : -1;
                ::kill(pid, SIGKILL);
              }});
  return left;
}

TEST(HaplyDeath, SaysZeroLastWhateverItDiesOf) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) {
    const double left = forceAfter(signal, DeadMan::kKeepsForEver);
    if (left < 0) GTEST_SKIP() << "this machine is too busy for an arm that the gate lets push";
    EXPECT_EQ(left, 0) << ::strsignal(signal);
  }
}

TEST(HaplyDeath, LeavesAKilledProgramsForceToTheService) {
  const double kept = forceAfter(SIGKILL, DeadMan::kKeepsForEver);
  if (kept < 0) GTEST_SKIP() << "this machine is too busy for an arm that the gate lets push";
  EXPECT_GT(kept, 0) << "nothing can be done: the power switch is the last stop";
  EXPECT_LE(forceAfter(SIGKILL, DeadMan::kIdleAfter), 0);
  EXPECT_LE(forceAfter(SIGKILL, DeadMan::kZeroOnClose), 0);
  EXPECT_LE(forceAfter(SIGSTOP, DeadMan::kIdleAfter), 0);
}

}  // namespace
}  // namespace pincer::tests
