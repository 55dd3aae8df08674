// usb_scenarios: what happens to USB devices in the tests and in devices_bench, in virtual time.
#pragma once
#include <dirent.h>
#include <malloc.h>

#include "pincer/devices/gate/force_gate.h"
#include "pincer/tests/devices/usb_bench.h"

namespace pincer::tests {

// One arm under a servo at 1 kHz, with an operator who arms again whenever forces were cut. Counts what must never be.
class FaultyServo {
  template <typename F>
  auto with(F f) {
    return bench_.bus.device(0).with(f);
  }
  std::int64_t heard() {
    return with([&] { return firmware_.commands() + firmware_.badFrames(); });
  }

 public:
  FaultyServo(UsbBench& bench, emulation::ArmFirmware& firmware, devices::usb::UsbHost& host)
      : bench_(bench), firmware_(firmware), host_(host) {}

  bool find() { return findAll(bench_, host_, 1, 0) && (arm_ = host_.arms()[0]) != nullptr; }

  // `rearms`: false when there is no operator.
  void tick(bool rearms = true) {
    const auto before = heard();
    bench_.advance(1e-3);
    if (rearms && (gate_.trip != devices::Trip::kNone || !gate_.armed)) rearm();
    devices::GateInput in;
    in.sample = arm_->sample();
    in.now = 1e-9 * static_cast<double>(bench_.now_ns);
    in.f_D = Vec3(0, 0, 0.5);
    if (in.sample.valid && !with([&] { return firmware_.hasSent(in.sample.p_DF); })) ++unsound_;
    asked_ = devices::gateForce(limits_, in, gate_);
    arm_->commandForce(asked_);
    // The USB thread gets a chance, not a guarantee: a lost command is one of the faults.
    // where a machine is busy, one yield takes 50
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(2);
    while (heard() == before && std::chrono::steady_clock::now() < until) std::this_thread::yield();
    look();
  }
  devices::usb::UsbArm& arm() { return *arm_; }
  Vec3 asked() const { return asked_; }  // the gate's last force [N]
  devices::Trip trip() const { return gate_.trip; }
  int trips() const { return trips_; }      // so often forces were cut and switched on again
  int unsound() const { return unsound_; }  // positions believed that the device never sent
  // ticks with a force that nobody had asked for lately, or larger than ever asked
  int stuck() const { return stuck_; }

 private:
  void rearm() {
    ++trips_;
    devices::arm(gate_);
    arm_->arm();
  }
  void look() {
    const auto commands = with([&] { return firmware_.commands(); });
    silent_ = commands == commands_ ? silent_ + 1 : 0;
    commands_ = commands;
    const double force = with([&] { return firmware_.force().norm(); });
    if (force > 0.5 + 1e-6 || (silent_ > 5 && force > 0)) ++stuck_;
  }

  UsbBench& bench_;
  emulation::ArmFirmware& firmware_;
  devices::usb::UsbHost& host_;
  devices::usb::UsbArm* arm_ = nullptr;
  devices::GateLimits limits_;
  devices::GateState gate_;
  Vec3 asked_ = Vec3::Zero();
  std::int64_t commands_ = 0;
  int silent_ = 0, trips_ = 0, unsound_ = 0, stuck_ = 0;
};

inline emulation::TransferFault faultKind(int i) {
  return static_cast<emulation::TransferFault>(1 + i % emulation::kTransferFaults);
}

// While streaming: `faults` faults at transfers in turn, both directions, all kinds.
inline void injectFaults(UsbBench& bench, FaultyServo& servo, int faults) {
  for (int i = 0; i < faults; ++i) {
    bench.bus.device(0).injectAt(i % 3, i % 2 == 0, faultKind(i / 2));
    for (int t = 0; t < 4; ++t) servo.tick();
  }
  for (int t = 0; t < 20; ++t) servo.tick();
}

inline int openDescriptors() {
  int count = 0;
  DIR* directory = opendir("/proc/self/fd");
  while (readdir(directory) != nullptr) ++count;
  closedir(directory);
  return count;
}

struct PlugCycles {
  int done = 0;
  int descriptors = 0;      // more than before
  double bytes = 0;         // of memory more than before, per cycle
  double worst_stream = 0;  // from plugging in to the first valid sample [s of the wall clock]
};

// One device pulled out and plugged in again, over and over.
inline PlugCycles plugCycles(UsbBench& bench, devices::usb::UsbArm& arm, int cycles) {
  PlugCycles result;
  int descriptors = 0;
  double memory = 0;
  constexpr int kWarmUp = 5;
  for (int i = -kWarmUp; i < cycles; ++i) {
    if (i == 0) descriptors = openDescriptors(), memory = static_cast<double>(mallinfo2().uordblks);
    bench.bus.unplug(0);
    if (!eventually([&] { return arm.state() == devices::DeviceState::kConnecting; })) break;
    const auto plugged = std::chrono::steady_clock::now();
    bench.bus.plug(0);
    const bool streams = eventually([&] {
      bench.advance(1e-3);
      return arm.sample().valid;
    });
    if (!streams) break;
    if (i < 0) continue;
    result.worst_stream = std::max(result.worst_stream,
                                   std::chrono::duration<double>(std::chrono::steady_clock::now() - plugged).count());
    result.done = i + 1;
  }
  // The USB thread closes what is gone in its own time, and opens files of sysfs for a moment; a leak stays.
  int least = openDescriptors();
  eventually([&] { return (least = std::min(least, openDescriptors())) <= descriptors; });
  result.descriptors = least - descriptors;
  result.bytes = (static_cast<double>(mallinfo2().uordblks) - memory) / std::max(1, result.done);
  return result;
}

}  // namespace pincer::tests
