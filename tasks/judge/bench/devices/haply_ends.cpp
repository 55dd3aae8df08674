// The program ends while an emulated Inverse3 pushes, by a signal that it hears or by one that nobody does.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tasks/judge/bench/devices/haply_parts.h"
#include "pincer/tasks/run/process/child_process.h"

namespace pincer::tasks {
namespace {

using devices::emulate::DeadMan;
using devices::emulate::HaplyServer;

constexpr int kDeaths = 3;          // per signal, odd for a median; few, since each begins and ends a process
constexpr double kIdleAfter = 100;  // of the service that has a deadline of its own [ms]

void pauseMs(double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); }

devices::emulate::HaplyServiceSettings serviceThat(DeadMan dead_man) {
  devices::emulate::HaplyServiceSettings settings;
  for (auto& arm : settings.arms) arm.dead_man = dead_man, arm.idle_after = 1e-3 * kIdleAfter;
  return settings;
}

// From `signal` to zero at the motors [ms]; infinite: it stayed, or never pushed.
double msToZero(int signal, DeadMan dead_man) {
  HaplyServer server(serviceThat(dead_man));
  std::error_code error;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe", error).string();
  // Its words are for nobody: the file "null" of the folder of devices.
  const ChildProcess child({self, "devices", "test", "049D", "--devices", "haply", "--force", "0.3", "--yes",
                            "--watchdog", "100", "--service", server.place()},
                           "/dev", "null");
  for (int i = 0; i < 10'000 && server.force(0) < 0.1; ++i) pauseMs(1);
  const std::int64_t begin = devices::usb::monotonicNs();
  const bool pushed = server.force(0) > 0;
  ::kill(child.process(), signal);
  for (int i = 0; i < 10'000 && server.zeroSince(0) == 0; ++i) pauseMs(0.1);
  const std::int64_t zero = server.zeroSince(0);
  ::kill(child.process(), SIGKILL);
  return pushed && zero >= begin ? 1e-6 * static_cast<double>(zero - begin) : std::numeric_limits<double>::infinity();
}

double medianMs(MeasureContext& context, int signal, DeadMan dead_man) {
  std::array<double, kDeaths> ms{};
  for (double& time : ms) {
    if (!context.interrupted()) time = msToZero(signal, dead_man);
  }
  std::sort(ms.begin(), ms.end());
  return ms[kDeaths / 2];
}

}  // namespace

std::vector<Record> haplyEnds(MeasureContext& context) {
  std::vector<Record> records;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT}) {
    records.push_back(atMost(
        fmt::format("SIG{} to zero, where forces are kept for ever, median of {}", ::sigabbrev_np(signal), kDeaths),
        medianMs(context, signal, DeadMan::kKeepsForEver), "ms", 5));
  }
  for (const int signal : {SIGKILL, SIGSTOP}) {
    records.push_back(atMost(
        fmt::format("SIG{} to zero, where the service idles after {:.0f} ms", ::sigabbrev_np(signal), kIdleAfter),
        medianMs(context, signal, DeadMan::kIdleAfter), "ms", kIdleAfter + 1));
  }
  return records;
}

}  // namespace pincer::tasks
