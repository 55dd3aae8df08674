// The program ends while an Inverse3 pushes: by a signal, asked for or not, the last word is zero. The service keeps forces for ever.
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
  spawnPincer(
      {"devices", "test", "049D", "--devices", "haply", "--force", "0.3", "--yes", "--watchdog", "100", "--service", server.place()},
      {.meanwhile = [&](pid_t pid) {
        bool pushed = false;
        for (int i = 0; i < 10000 && !pushed; ++i) {
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
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGABRT})
    EXPECT_EQ(forceAfter(signal, DeadMan::kKeepsForEver), 0) << ::strsignal(signal);
}

TEST(HaplyDeath, LeavesAKilledProgramsForceToTheService) {
  EXPECT_GT(forceAfter(SIGKILL, DeadMan::kKeepsForEver), 0) << "nothing can be done: the power switch is the last stop";
  EXPECT_EQ(forceAfter(SIGKILL, DeadMan::kIdleAfter), 0);
  EXPECT_EQ(forceAfter(SIGKILL, DeadMan::kZeroOnClose), 0);
  EXPECT_EQ(forceAfter(SIGSTOP, DeadMan::kIdleAfter), 0);
}

}  // namespace
}  // namespace pincer::tests
