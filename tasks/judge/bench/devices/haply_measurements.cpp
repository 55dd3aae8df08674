// Haply's Inverse3 over the emulated service, real sockets and threads in this process. Tails are this machine's, and so are only told.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <thread>

#include "pincer/devices/emulate/haply_server.h"
#include "pincer/devices/haply/haply_host.h"
#include "pincer/devices/usb/usb_bus.h"
#include "pincer/tasks/judge/bench/devices/devices_bench.h"
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

// The time within which the share `q` of all came back, to 0.05 ms [ms].
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

// Two arms and two grips as the service tells them, 2 kB: how long reading takes [us].
double readingTime() {
  HaplyService service;
  std::string text;
  service.connected(text);
  devices::haply::ServiceMessage message;
  constexpr int kReadings = 2000;
  const std::int64_t begin = devices::usb::monotonicNs();
  for (int i = 0; i < kReadings; ++i) readService(text, message);
  return 1e-3 * static_cast<double>(devices::usb::monotonicNs() - begin) / kReadings;
}

std::vector<Record> streaming(double seconds) {
  HaplyServer server;
  HaplyHost host(bothArmsOf(server));
  host.waitReady(10);
  for (std::size_t i = 0; i < 2; ++i) host.arm(i).arm();
  BothArms cycle(host, seconds);
  const ServoReport report = runServo({.clock = ServoClock::kReal, .watchdog = 1}, cycle, std::atomic<bool>(false));
  cycle.cutForces();
  const double due = static_cast<double>(std::max<std::int64_t>(1, report.ticks + report.missed));
  return {atMost("round trip of two arms, median", tripQuantile(host.roundTrips(), 0.5), "ms", 0.15),
          unbounded("round trip, 99.9 %", tripQuantile(host.roundTrips(), 0.999), "ms"),
          unbounded("ticks missed, of 1 kHz", 100 * static_cast<double>(report.missed) / due, "%"),
          unbounded("ticks with a sample", 100 * cycle.validShare(), "%"),
          exactly("answers that weren't sound", static_cast<double>(host.counts().unsound), "-", 0),
          atMost("reading 2 kB", readingTime(), "us", 60)};
}

// From `cut` to zero at the first arm's motors, median and longest [ms]. The arms push before.
std::array<double, 2> timeToZero(MeasureContext& context, const std::function<void(HaplyServer&, HaplyHost&)>& cut, bool pushes_on) {
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
    const std::int64_t begin = devices::usb::monotonicNs();
    cut(server, host);
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
          context, [](HaplyServer&, HaplyHost& host) { host.arm(0).stop(); }, true));
  add("not a number", 1.5,
      timeToZero(
          context, [](HaplyServer&, HaplyHost& host) { host.arm(0).commandForce(Vec3::Constant(std::nan(""))); }, false));
  add("a stalled servo", 5,
      timeToZero(
          context, [](HaplyServer&, HaplyHost&) {}, false));
  add("a device that is gone", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { server.setFault(HaplyFault::kDeviceGone); }, true));
  add("busy", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { server.setFault(HaplyFault::kBusy); }, true));
  add("a safety event", 1.5,
      timeToZero(
          context, [](HaplyServer& server, HaplyHost&) { server.setFault(HaplyFault::kStall); }, true));
  return records;
}

std::ptrdiff_t entriesIn(const char* folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator{});
}

std::vector<Record> connections(MeasureContext& context, int cycles) {
  HaplyServer server;
  std::ptrdiff_t descriptors = 0, threads = 0;
  double slowest = 0;
  for (int i = 0; i <= cycles && !context.interrupted(); ++i) {
    context.progress(static_cast<double>(i) / cycles);
    {
      const std::int64_t begin = devices::usb::monotonicNs();
      HaplyHost host(bothArmsOf(server));
      host.waitReady(10);
      if (i > 0) slowest = std::max(slowest, msSince(begin, devices::usb::monotonicNs()));
    }
    while (server.connections() > 0) sleepMs(1);
    if (i == 0) descriptors = entriesIn("/proc/self/fd"), threads = entriesIn("/proc/self/task");
  }
  return {exactly(fmt::format("descriptors left behind by {} connections", cycles),
                  static_cast<double>(entriesIn("/proc/self/fd") - descriptors), "-", 0),
          unbounded("threads beside those before", static_cast<double>(entriesIn("/proc/self/task") - threads), "-"),
          unbounded("from nothing to ready, half a second of zeros included, slowest", slowest, "ms")};
}

// Every fault while both arms push: where does a force last, or a sample count that isn't sound?
std::vector<Record> faults(MeasureContext& context) {
  int stuck = 0, believed = 0, done = 0;
  for (std::size_t k = 1; k < devices::emulate::kHaplyFaults && !context.interrupted(); ++k) {
    const auto fault = static_cast<HaplyFault>(k);
    if (isHarmless(fault)) continue;
    context.progress(static_cast<double>(k) / static_cast<double>(devices::emulate::kHaplyFaults));
    HaplyServer server;
    server.setDelay(std::chrono::milliseconds(500));
    HaplyHost host(bothArmsOf(server));
    host.waitReady(10);
    host.arm(0).arm();
    for (int i = 0; i < 5000 && server.force(0) < 0.29; ++i) host.arm(0).commandForce(0.3 * kPush), sleepMs(1);
    server.setFault(fault);
    for (int i = 0; i < 1200; ++i) host.arm(0).commandForce(kPush), sleepMs(1);
    stuck += server.force(0) != 0 ? 1 : 0;
    believed += host.arm(0).sample().valid ? 1 : 0;
    ++done;
  }
  return {unbounded("faults while pushing", done, "-"), exactly("forces that last", stuck, "-", 0),
          exactly("samples believed that weren't sound", believed, "-", 0)};
}

}  // namespace

std::vector<Measurement> haplyMeasurements(const DevicesBenchOptions& options) {
  constexpr int kOneIn = 50;  // a connection begins with half a second of zeros
  return {{"haply/stream", [s = options.seconds](MeasureContext&) { return streaming(s); }},
          {"haply/zero", zeros},
          {"haply/faults", faults},
          {"haply/connections", [n = std::max(1, options.cycles / kOneIn)](MeasureContext& context) { return connections(context, n); }}};
}

}  // namespace pincer::tasks
