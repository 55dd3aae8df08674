// devices_bench: what `pincer bench devices` shows of USB, measured with emulated
// devices under the real libusb in this process.
//
//   devices_bench [SECONDS [CYCLES]]     a line per figure: name, metric, value,
//                                        unit, relation, bound, with tabs between
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "pincer/tasks/run/servo/servo.h"
#include "pincer/tests/devices/usb_scenarios.h"

namespace pincer::tests {
namespace {

using devices::usb::UsbArm;
using devices::usb::UsbDisplay;
using devices::usb::UsbHost;

constexpr double kNoBound = std::numeric_limits<double>::infinity();

void show(const char* name, const char* metric, double value, const char* unit,
          const char* relation = "<=", double bound = kNoBound) {
  fmt::print("{}\t{}\t{}\t{}\t{}\t{}\n", name, metric, value, unit, relation, bound);
  std::fflush(stdout);
}

void showMissing(const char* name) { show(name, "devices found", 0, "-", "==", 1); }

// Both hands in real time: samples, gate, commands to all four devices in every tick.
class TwoHands final : public tasks::ServoCycle {
 public:
  TwoHands(UsbHost& host, double seconds)
      : host_(host), arms_(host.arms()), displays_(host.displays()), seconds_(seconds), gates_(arms_.size()) {
    // a shared machine's stalls are counted, not answered: how forces end is measured by itself
    limits_.watchdog_time = 1;
  }
  bool tick(double now) override {
    const std::int64_t epoch = devices::usb::monotonicNs() - static_cast<std::int64_t>(1e9 * now);
    if (ticks_ == 0 || epoch < epoch_) host_.setEpoch(epoch_ = epoch);
    for (std::size_t i = 0; i < arms_.size(); ++i) drive(i, now);
    for (std::size_t i = 0; i < displays_.size(); ++i) {
      displays_[i]->command({false, Vec2(5e-3 * std::sin(now), 3e-3 * std::cos(now))});
      measure(displays_[i]->counts(), arms_.size() + i);
    }
    ++ticks_;
    return now < seconds_;
  }
  void cutForces() noexcept override {
    for (UsbArm* arm : arms_) arm->stop();
  }
  std::int64_t ticks() const { return ticks_; }
  int armings() const { return armings_; }
  const tasks::Histogram& roundTrips() const { return round_trips_; }

 private:
  void drive(std::size_t i, double now) {
    if (!gates_[i].armed) {
      devices::arm(gates_[i]);
      arms_[i]->arm();
      ++armings_;
    }
    devices::GateInput in;
    in.sample = arms_[i]->sample();
    in.now = now;
    in.f_D = Vec3(0, 0, 0.3 * std::sin(now));
    arms_[i]->commandForce(devices::gateForce(limits_, in, gates_[i]));
    measure(arms_[i]->counts(), i);
  }
  void measure(const devices::usb::LinkCounts& counts, std::size_t i) {
    if (counts.answers == answers_[i]) return;
    answers_[i] = counts.answers;
    round_trips_.add(1e-9 * static_cast<double>(counts.round_trip_ns));
  }

  UsbHost& host_;
  std::vector<UsbArm*> arms_;
  std::vector<UsbDisplay*> displays_;
  double seconds_;
  std::vector<devices::GateState> gates_;
  devices::GateLimits limits_;
  std::array<std::int64_t, 8> answers_{};
  tasks::Histogram round_trips_;
  std::int64_t ticks_ = 0, epoch_ = 0;
  int armings_ = 0;
};

void twoHands(double seconds) {
  emulation::EmulatedBus bus;
  for (const char* serial : {"A1", "A2"}) bus.add(std::make_shared<emulation::ArmFirmware>(serial));
  for (const char* serial : {"D1", "D2"}) bus.add(std::make_shared<emulation::DisplayFirmware>(serial));
  bus.runInRealTime();
  UsbHost host;
  if (!host.waitFor(2, 2, 20)) return showMissing("usb/two hands");
  std::int64_t lost = 0, bad = 0, late = 0, twice = 0;
  const auto count = [&](int sign) {
    const auto add = [&](const devices::usb::LinkCounts& c) {
      lost += sign * c.lost, bad += sign * c.bad, late += sign * c.late, twice += sign * c.duplicates;
    };
    for (UsbArm* arm : host.arms()) add(arm->counts());
    for (UsbDisplay* display : host.displays()) add(display->counts());
  };
  count(-1);
  TwoHands cycle(host, seconds);
  const std::atomic<bool> never{false};
  tasks::ServoOptions servo;
  servo.clock = tasks::ServoClock::kReal;
  servo.watchdog = 1;
  const tasks::ServoReport report = runServo(servo, cycle, never);
  count(1);
  const auto due = static_cast<double>(report.ticks + report.missed);
  show("usb/two hands", "seconds at 1 kHz", report.wall, "s");
  show("usb/two hands", "round trip, median", 1e6 * cycle.roundTrips().quantile(0.5), "us", "<=", 1000);
  show("usb/two hands", "round trip, 99.9 %", 1e6 * cycle.roundTrips().quantile(0.999), "us");
  show("usb/two hands", "commands answered, of those sent",
       static_cast<double>(cycle.roundTrips().count()) / (4 * static_cast<double>(report.ticks)), "-");
  show("usb/two hands", "frames lost", static_cast<double>(lost), "-", "==", 0);
  show("usb/two hands", "frames late, but not lost", static_cast<double>(late), "-");
  show("usb/two hands", "frames unsound or twice", static_cast<double>(bad + twice), "-", "==", 0);
  show("usb/two hands", "ticks missed (by this machine)", 100 * static_cast<double>(report.missed) / due, "%");
  show("usb/two hands", "tick began late by, 99.9 %", 1e6 * report.lateness.quantile(0.999), "us");
}

// An arm with a force on, in virtual time: only the bench's clock moves it on, and whatever the
// USB thread is asked for it does in no time.
class ForceEnds {
 public:
  ForceEnds() : firmware_(bench_.addArm("A1")), host_(bench_.clock()) { ok_ = findAll(bench_, host_, 1, 0); }
  // From a force on, `event` once, then `eachTick` per millisecond: when the emulated motor has none [ms].
  double after(const std::function<void(UsbArm&)>& event, const std::function<void(UsbArm&)>& eachTick) {
    if (!ok_) return kNoBound;
    UsbArm& arm = *host_.arms()[0];
    arm.arm();
    for (int i = 0; i < 20; ++i) {
      bench_.advance(1e-3);
      const auto before = taken();
      arm.commandForce(Vec3(0, 0, 1));
      if (!eventually([&] { return taken() > before; })) return kNoBound;  // none is under way when the event comes
    }
    if (zero()) return kNoBound;
    event(arm);
    for (int ms = 0; ms < 100; ++ms) {
      for (int turn = 0; turn < 100 && !zero(); ++turn) std::this_thread::sleep_for(std::chrono::microseconds(500));
      if (zero()) return ms;
      bench_.advance(1e-3);
      eachTick(arm);
    }
    return kNoBound;
  }

 private:
  bool zero() {
    return bench_.bus.device(0).with([&] { return firmware_->force().isZero(0); });
  }
  std::int64_t taken() {
    return bench_.bus.device(0).with([&] { return firmware_->commands(); });
  }
  UsbBench bench_;
  std::shared_ptr<emulation::ArmFirmware> firmware_;
  UsbHost host_;
  bool ok_ = false;
};

void endsOfForce() {
  const auto nothing = [](UsbArm&) {};
  show("usb/force ends", "after the last command (a loop that stands still, a dead computer), in virtual time",
       ForceEnds().after(nothing, nothing), "ms", "<=", 5);
  show("usb/force ends", "after the watchdog's stop, in virtual time",
       ForceEnds().after([](UsbArm& arm) { arm.stop(); }, nothing), "ms", "<=", 5);
  const auto notANumber = [](UsbArm& arm) {
    arm.commandForce(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  };
  show("usb/force ends", "after a force that isn't a number, in virtual time",
       ForceEnds().after(notANumber, notANumber), "ms", "<=", 5);
}

// In real time: pushes, then sticks in a tick for 30 ms.
class Stalls final : public tasks::ServoCycle {
 public:
  explicit Stalls(UsbArm& arm) : arm_(arm) { arm_.arm(); }
  bool tick(double) override {
    arm_.commandForce(Vec3(0, 0, 1));
    if (++ticks_ < 100) return true;
    stalled_ns_ = devices::usb::monotonicNs();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    return false;
  }
  void cutForces() noexcept override { arm_.stop(); }
  std::int64_t stalledNs() const { return stalled_ns_; }

 private:
  UsbArm& arm_;
  int ticks_ = 0;
  std::atomic<std::int64_t> stalled_ns_{0};
};

// From the begin of the stall to the first millisecond in which the emulated motor has no force [ms].
double msAfterAStall() {
  emulation::EmulatedBus bus;
  const auto firmware = std::make_shared<emulation::ArmFirmware>("A1");
  bus.add(firmware);
  std::atomic<const Stalls*> cycle{nullptr};
  std::atomic<std::int64_t> zero_ns{0};
  bus.runInRealTime([&] {
    const Stalls* stalls = cycle;
    if (stalls == nullptr || stalls->stalledNs() == 0 || zero_ns != 0) return;
    if (bus.device(0).with([&] { return firmware->force().isZero(0); })) zero_ns = devices::usb::monotonicNs();
  });
  UsbHost host;
  if (!host.waitFor(1, 0, 20)) return kNoBound;
  Stalls stalls(*host.arms()[0]);
  cycle = &stalls;
  const std::atomic<bool> never{false};
  tasks::ServoOptions servo;
  servo.clock = tasks::ServoClock::kReal;
  runServo(servo, stalls, never);
  bus.stopRealTime();
  return zero_ns == 0 ? kNoBound : 1e-6 * static_cast<double>(zero_ns - stalls.stalledNs());
}

void endOfForceAfterAStall() {
  std::array<double, 9> ms;
  for (double& m : ms) m = msAfterAStall();
  std::sort(ms.begin(), ms.end());
  show("usb/force ends", "after a tick that doesn't end, in real time, median of 9", ms[4], "ms", "<=", 5);
  show("usb/force ends", "the longest of them (this machine's pauses included)", ms[8], "ms");
}

class Throws final : public tasks::ServoCycle {
 public:
  explicit Throws(UsbArm& arm) : arm_(arm) {}
  bool tick(double) override { throw std::runtime_error("a fault in the tick"); }
  void cutForces() noexcept override { arm_.stop(); }

 private:
  UsbArm& arm_;
};

void endOfForceAfterAnException() {
  const auto thrown = [](UsbArm& arm) {
    Throws cycle(arm);
    const std::atomic<bool> never{false};
    try {
      runServo({}, cycle, never);
    } catch (const std::runtime_error&) {
    }
  };
  show("usb/force ends", "after an exception in a tick, in virtual time", ForceEnds().after(thrown, [](UsbArm&) {}),
       "ms", "<=", 5);
}

void unplugged() {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  FaultyServo servo(bench, *firmware, host);
  if (!servo.find()) return showMissing("usb/unplugged");
  for (int i = 0; i < 500; ++i) servo.tick();
  bench.bus.unplug(0);
  eventually([&] { return servo.arm().state() != devices::DeviceState::kReady; });
  int ticks = 0;
  do {
    servo.tick(false);
    ++ticks;
  } while (!servo.asked().isZero(0) && ticks < 100);
  show("usb/unplugged", "ticks from its detection to zero force", ticks, "-", "<=", 1);
  show("usb/unplugged", "latched", servo.trip() != devices::Trip::kNone ? 1 : 0, "-", "==", 1);
}

void plugs(int cycles) {
  UsbBench bench;
  bench.addArm("A1");
  UsbHost host(bench.clock());
  if (!findAll(bench, host, 1, 0)) return showMissing("usb/plugs");
  const PlugCycles result = plugCycles(bench, *host.arms()[0], cycles);
  show("usb/plugs", "cycles", result.done, "-", ">=", cycles);
  show("usb/plugs", "streaming again after, worst", 1e3 * result.worst_stream, "ms", "<=", 500);
  show("usb/plugs", "file descriptors leaked", result.descriptors, "-", "<=", 0);
  show("usb/plugs", "memory more, per cycle", result.bytes, "bytes", "<=", cycles < 100 ? 2048 : 256);
}

void faults() {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  FaultyServo servo(bench, *firmware, host);
  if (!servo.find()) return showMissing("usb/faults");
  injectFaults(bench, servo, 2 * emulation::kTransferFaults * 40);
  show("usb/faults", "injected, of 14 kinds in both directions", static_cast<double>(bench.bus.device(0).faultsDone()),
       "-", ">=", 1000);
  show("usb/faults", "unsound frames believed", servo.unsound(), "-", "==", 0);
  show("usb/faults", "ticks with a stuck force", servo.stuck(), "-", "==", 0);
  show("usb/faults", "so often the operator had to arm again", servo.trips(), "-");
}

int run(int argc, char** argv) {
  if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) {
    fmt::print(stderr, "devices_bench: {}\n", obstacle);
    return 4;
  }
  twoHands(argc > 1 ? std::atof(argv[1]) : 60);
  endsOfForce();
  endOfForceAfterAnException();
  endOfForceAfterAStall();
  unplugged();
  plugs(argc > 2 ? std::atoi(argv[2]) : 1000);
  faults();
  return 0;
}

}  // namespace
}  // namespace pincer::tests

int main(int argc, char** argv) { return pincer::tests::run(argc, argv); }
