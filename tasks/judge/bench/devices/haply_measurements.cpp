// Haply's Inverse3 over the emulated service, real sockets and threads in this process. Tails
// are this machine's, and so are only told.
#include <fmt/format.h>
#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"
#include "pincer/tasks/judge/bench/devices/haply_parts.h"
#include "pincer/tasks/run/measure/timing.h"
#include "pincer/tasks/run/servo/servo.h"

namespace pincer::tasks {
namespace {

using devices::emulate::HaplyFault;
using devices::emulate::HaplyServer;
using devices::emulate::HaplyService;
using devices::haply::HaplyHost;
using devices::haply::HaplyHostOptions;

const Vec3 kPush(0, 0, 1);         // [N]
constexpr int kTimes = 9;          // of which the median is shown
constexpr double kForgotten = 50;  // states that still tell of the last fault [ms]

HaplyHostOptions bothArmsOf(const HaplyServer& server) {
  HaplyHostOptions options;
  options.service = *devices::haply::servicePlaceOf(server.place());
  options.arms = {{.id = "049D", .grip = "1605", .frame = {}}, {.id = "04BA", .grip = "1606", .frame = {}}};
  return options;
}

void sleepMs(double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); }

double msSince(std::int64_t begin, std::int64_t end) { return 1e-6 * static_cast<double>(end - begin); }

// Samples and small forces of both arms in every tick.
class BothArms final : public ServoCycle {
 public:
  BothArms(HaplyHost& host, double seconds) : host_(host), seconds_(seconds) {}
  bool tick(double now) override {
    for (std::size_t i = 0; i < host_.arms(); ++i) {
      valid_ += host_.arm(i).sample().valid ? 1 : 0;
      host_.arm(i).commandForce(0.1 * kPush);
    }
    ++ticks_;
    return now < seconds_;
  }
  void cutForces() noexcept override {
    for (std::size_t i = 0; i < host_.arms(); ++i) host_.arm(i).stop();
  }
  double validShare() const { return static_cast<double>(valid_) / static_cast<double>(2 * ticks_); }

 private:
  HaplyHost& host_;
  double seconds_;
  std::int64_t ticks_ = 0, valid_ = 0;
};

// The time within which the share `q` of all came back, to 0.01 ms [ms].
double tripQuantile(const devices::haply::RoundTrips& trips, double q) {
  std::int64_t all = 0, seen = 0;
  for (const auto& bin : trips) all += bin;
  for (std::size_t i = 0; i < trips.size(); ++i) {
    seen += trips[i];
    if (static_cast<double>(seen) >= q * static_cast<double>(all))
      return 1e-6 * static_cast<double>((static_cast<std::int64_t>(i) + 1) * devices::haply::kTripStep);
  }
  return 0;
}

// Time of this thread on its processor [ns]: what else runs on the machine doesn't count.
std::int64_t threadNs() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1'000'000'000 * static_cast<std::int64_t>(now.tv_sec) + now.tv_nsec;
}

// Two arms and two grips as the service tells them, 2 kB: how long reading takes [us].
double readingTime() {
  HaplyService service;
  std::string text;
  service.connected(text);
  devices::haply::ServiceMessage message;
  constexpr int kReadings = 2000;  // texts that the mean is taken over: a tenth of a second; chosen
  const std::int64_t begin = threadNs();
  for (int i = 0; i < kReadings; ++i) readService(text, message);
  return 1e-3 * static_cast<double>(threadNs() - begin) / kReadings;
}

// A servo with nothing to do: the ticks that it misses are the machine's.
class Idles final : public ServoCycle {
 public:
  explicit Idles(double seconds) : seconds_(seconds) {}
  bool tick(double now) override { return now < seconds_; }
  void cutForces() noexcept override {}

 private:
  double seconds_;
};

// Ticks of 1 kHz that the clock didn't wait for [%].
double missedIn(ServoCycle& cycle) {
  const ServoReport report = runServo({.clock = ServoClock::kReal, .watchdog = 1}, cycle, std::atomic<bool>(false));
  const auto due = static_cast<double>(std::max<std::int64_t>(1, report.ticks + report.missed));
  return 100 * static_cast<double>(report.missed) / due;
}

std::vector<Record> streaming(double seconds) {
  HaplyServer server;
  HaplyHost host(bothArmsOf(server));
  host.waitReady(10);
  for (std::size_t i = 0; i < 2; ++i) host.arm(i).arm();
  BothArms cycle(host, seconds);
  double missed_idle = 0;
  std::thread beside([&] {
    Idles idles(seconds);
    missed_idle = missedIn(idles);
  });
  const double missed = missedIn(cycle);
  beside.join();
  cycle.cutForces();
  return {atMost("round trip of two arms, median", tripQuantile(host.roundTrips(), 0.5), "ms", 0.15),
          unbounded("round trip, 99.9 %", tripQuantile(host.roundTrips(), 0.999), "ms"),
          unbounded("ticks missed, of 1 kHz", missed, "%"),
          unbounded("ticks missed by a loop beside it that does nothing", missed_idle, "%"),
          unbounded("ticks with a sample", 100 * cycle.validShare(), "%"),
          exactly("answers that weren't sound", static_cast<double>(host.counts().unsound), "-", 0),
          atMost("reading 2 kB", readingTime(), "us", 60)};
}

// Ends a force. The time of it, on the monotonic clock [ns]; 0: as it was called.
using Cut = std::function<std::int64_t(HaplyServer&, HaplyHost&)>;

// A servo that pushes and then throws: after some ticks, for the last push before it began may have been forgotten.
class Throws final : public ServoCycle {
 public:
  explicit Throws(HaplyHost& host) : host_(host) {}
  bool tick(double) override {
    constexpr int kPushes = 50;  // [ticks] of 1 ms; chosen
    host_.arm(0).commandForce(kPush);
    if (++ticks_ < kPushes) return true;
    thrown = devices::usb::monotonicNs();
    throw std::runtime_error("a tick that fails");
  }
  void cutForces() noexcept override {
    for (std::size_t i = 0; i < host_.arms(); ++i) host_.arm(i).stop();
  }
  std::int64_t thrown = 0;

 private:
  HaplyHost& host_;
  int ticks_ = 0;
};

// From `cut` to zero at the first arm's motors, median and longest [ms]. The arms push before.
std::array<double, 2> timeToZero(MeasureContext& context, const Cut& cut, bool pushes_on) {
  std::array<double, kTimes> ms{};
  HaplyServer server;
  HaplyHost host(bothArmsOf(server));
  host.waitReady(10);
  for (double& time : ms) {
    if (context.interrupted()) break;
    server.setFault(HaplyFault::kNone);
    sleepMs(kForgotten);
    host.arm(0).arm();
    const auto push = [&] { host.arm(0).commandForce(kPush); };
    for (int i = 0; i < 5000 && server.force(0) < 0.99; ++i) push(), sleepMs(1);
    push();
    const std::int64_t began = devices::usb::monotonicNs(), told = cut(server, host), begin = std::max(began, told);
    for (int i = 0; i < 20000 && server.zeroSince(0) == 0; ++i) {
      if (pushes_on) push();
      sleepMs(0.1);
    }
    const std::int64_t zero = server.zeroSince(0);
    time = zero >= begin ? msSince(begin, zero) : std::numeric_limits<double>::infinity();  // it never pushed
    host.arm(0).stop();
    sleepMs(5);
  }
  std::sort(ms.begin(), ms.end());
  return {ms[kTimes / 2], ms.back()};
}

std::vector<Record> zeros(MeasureContext& context) {
  std::vector<Record> records;
  const auto add = [&](const char* what, double bound, const std::array<double, 2>& ms) {
    records.push_back(atMost(fmt::format("{} to zero, median of {}", what, kTimes), ms[0], "ms", bound));
    records.push_back(unbounded("the longest of them", ms[1], "ms"));
  };
  add("stop()", 1.5,
      timeToZero(
          context, [](HaplyServer&, HaplyHost& host) { return host.arm(0).stop(), 0; }, true));
  add("not a number", 1.5,
      timeToZero(
          context,
          [](HaplyServer&, HaplyHost& host) { return host.arm(0).commandForce(Vec3::Constant(std::nan(""))), 0; },
          false));
  add("a stalled servo", 5,
      timeToZero(
          context, [](HaplyServer&, HaplyHost&) { return 0; }, false));
  add("an exception in a tick", 1.5,
      timeToZero(
          context,
          [](HaplyServer&, HaplyHost& host) {
            Throws cycle(host);
            try {
              runServo({.clock = ServoClock::kReal, .watchdog = 1}, cycle, std::atomic<bool>(false));
            } catch (const std::runtime_error&) {
            }
            return cycle.thrown;
          },
          false));
  add("a device that is gone", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { return server.setFault(HaplyFault::kDeviceGone), 0; }, true));
  add("busy", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { return server.setFault(HaplyFault::kBusy), 0; }, true));
  add("a safety event", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { return server.setFault(HaplyFault::kStall), 0; }, true));
  return records;
}

std::ptrdiff_t entriesIn(const char* folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator{});
}

std::vector<Record> connections(MeasureContext& context, int cycles) {
  HaplyServer server;
  std::ptrdiff_t descriptors = 0, threads = 0;
  double slowest_state = 0, slowest = 0, bytes = 0;
  for (int i = 0; i <= cycles && !context.interrupted(); ++i) {
    context.progress(static_cast<double>(i) / cycles);
    {
      const std::int64_t begin = devices::usb::monotonicNs();
      HaplyHost host(bothArmsOf(server));
      while (host.counts().answered == 0) sleepMs(0.5);
      if (i > 0) slowest_state = std::max(slowest_state, msSince(begin, devices::usb::monotonicNs()));
      host.waitReady(10);
      if (i > 0) slowest = std::max(slowest, msSince(begin, devices::usb::monotonicNs()));
    }
    while (server.connections() > 0) sleepMs(1);
    server.forget();
    if (i == 0) descriptors = entriesIn("/proc/self/fd"), threads = entriesIn("/proc/self/task");
    if (i == 0) bytes = static_cast<double>(::mallinfo2().uordblks);
  }
  return {exactly(fmt::format("descriptors left behind by {} connections", cycles),
                  static_cast<double>(entriesIn("/proc/self/fd") - descriptors), "-", 0),
          exactly("threads left behind", static_cast<double>(entriesIn("/proc/self/task") - threads), "-", 0),
          atMost("memory per connection, the service's too",
                 (static_cast<double>(::mallinfo2().uordblks) - bytes) / cycles, "bytes", 100),
          atMost("from nothing to states that stream, slowest", slowest_state, "ms", 300),
          atMost("from nothing to ready, half a second of zeros included, slowest", slowest, "ms", 800)};
}

enum class Phase { kConnect, kSettle, kStream, kPush, kClose };
// All of them, in the order of a run.
constexpr std::array kPhases{Phase::kConnect, Phase::kSettle, Phase::kStream, Phase::kPush, Phase::kClose};

struct FaultCounts {
  int done = 0, stuck = 0, strong = 0, believed = 0;
};

// A fresh sample that isn't where the arm is. An old one is the gate's, which trusts none.
bool isUnsound(HaplyServer& server, HaplyHost& host) {
  constexpr double kFar = 5e-3, kOld = 3e-3;  // [m], [s]
  const devices::ArmSample sample = host.arm(0).sample();
  Vec3 truth = Vec3::Zero();
  server.with([&](HaplyService& service) { truth = service.plant(0).arm().sample().p_DF; });
  // its age as the truth is read: the machine may have stood still in between, while the arm went on
  if (!sample.valid || 1e-9 * static_cast<double>(devices::usb::monotonicNs()) - sample.time > kOld) return false;
  return !((sample.p_DF - truth).norm() < kFar);
}

// One fault, which begins in `phase`: what remains when all is over, and what was let through meanwhile.
void sufferFault(HaplyFault fault, Phase phase, FaultCounts& counts) {
  const double limit = phase == Phase::kPush || phase == Phase::kClose ? 1.001 : 0;  // [N]
  constexpr int kDoubted = 800;  // a place that is frozen is doubted after half a second, and no sooner [ms]
  HaplyServer server;
  server.setDelay(std::chrono::milliseconds(500));
  const auto watch = [&](HaplyHost* host, int ms) {
    for (int i = 0; i < ms; ++i, sleepMs(1)) {
      counts.strong += server.force(0) > limit ? 1 : 0;
      counts.believed += host != nullptr && i > kDoubted && isUnsound(server, *host) ? 1 : 0;
      if (host != nullptr && phase == Phase::kPush) host->arm(0).commandForce(kPush);
    }
  };
  if (phase == Phase::kConnect) server.setFault(fault);
  try {
    HaplyHost host(bothArmsOf(server));
    if (phase == Phase::kSettle) sleepMs(100), server.setFault(fault);
    if (phase > Phase::kSettle) host.waitReady(10);
    if (phase >= Phase::kPush) {
      host.arm(0).arm();
      for (int i = 0; i < 5000 && server.force(0) < 0.29; ++i) host.arm(0).commandForce(0.3 * kPush), sleepMs(1);
    }
    if (phase > Phase::kSettle) server.setFault(fault);
    if (phase != Phase::kClose) watch(&host, 1200);
    if (phase == Phase::kPush && !isHarmless(fault)) counts.stuck += server.force(0) != 0 ? 1 : 0;
    if (phase == Phase::kPush && !isHarmless(fault)) counts.believed += host.arm(0).sample().valid ? 1 : 0;
  } catch (const std::runtime_error&) {  // it was refused
  }
  watch(nullptr, 250);  // the service's own deadline is 0.1 s
  counts.stuck += server.force(0) != 0 ? 1 : 0;
  ++counts.done;
}

// Every fault from every phase on: where does a force last, or is stronger than asked
// for, or a sample counts that isn't sound?
std::vector<Record> faults(MeasureContext& context) {
  FaultCounts counts;
  std::size_t begun = 0;
  for (const Phase phase : kPhases) {
    for (std::size_t k = 1; k < devices::emulate::kHaplyFaults && !context.interrupted(); ++k) {
      context.progress(static_cast<double>(begun++) /
                       static_cast<double>(kPhases.size() * devices::emulate::kHaplyFaults));
      sufferFault(static_cast<HaplyFault>(k), phase, counts);
    }
  }
  return {unbounded("faults in five phases", counts.done, "-"), exactly("forces that last", counts.stuck, "-", 0),
          exactly("ms of a force over its limit", counts.strong, "-", 0),
          exactly("samples believed that weren't sound", counts.believed, "-", 0)};
}

}  // namespace

std::vector<Measurement> haplyMeasurements(const DevicesBenchOptions& options) {
  constexpr int kOneIn = 50;  // a connection begins with half a second of zeros
  return {{"haply/stream", [s = options.seconds](MeasureContext&) { return streaming(s); }},
          {"haply/zero", zeros},
          {"haply/faults", faults},
          {"haply/ends", haplyEnds},
          {"haply/texts", haplyTexts},
          {"haply/connections", [n = options.cycles](MeasureContext& context) {
             return connections(context, std::max(1, context.thorough ? n : n / kOneIn));
           }}};
}

}  // namespace pincer::tasks
