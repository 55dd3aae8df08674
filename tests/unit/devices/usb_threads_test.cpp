// The threads that meet in a USB host: the one that moves frames, the servo's, the watchdog's and the
// operator's. (Also run under ThreadSanitizer.)
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "pincer/devices/usb/usb_host.h"
#include "pincer/tests/emulation/firmware.h"
#include "pincer/tests/support/thread_bus.h"

namespace pincer::devices::usb {
namespace {

// An arm whose place and velocity are one number three times over, and that looks whether the forces it is sent are: a
// value that was read while it was written shows.
class WholeNumbersArm final : public emulation::Firmware {
 public:
  explicit WholeNumbersArm(const std::string& serial) : Firmware({DeviceKind::kArm, 1, 1000, "whole numbers", serial}) {
    calibration() = {{"base_x", 0.0}, {"base_turn", 0.5}};
  }
  std::atomic<std::int64_t> torn{0}, forces{0};

 private:
  Frame capabilities() const override {
    ArmCapabilities can;
    can.peak_force = can.continuous_force = 8;
    can.resolution = 1e-6;
    can.stiffness_limit = 1000;
    can.workspace_max_D.setOnes();
    return toFrame(can);
  }
  Frame state() override {
    ArmState state;
    state.valid = true;
    state.limp = limp_;
    number_ = number_ % 1'000'000 + 1;
    state.p_DF.setConstant(1e-6 * number_);
    state.v_DF = Vec3::Constant(1e-6 * number_);
    state.arming = arming_;
    state.answers = answers_;
    return toFrame(state);
  }
  bool command(const Frame& frame) override {
    const auto m = armCommandIn(frame);
    if (!m) return false;
    limp_ = m->arming == 0 || m->arming == refused_;
    arming_ = m->arming;
    if (m->f_D.x() != m->f_D.y() || m->f_D.y() != m->f_D.z()) ++torn;
    if (!limp_ && m->f_D.x() > 0) ++forces;
    return true;
  }
  void stop() override {
    refused_ = arming_;
    limp_ = true;
  }
  void advancePlant(double) override {}

  int number_ = 0;
  bool limp_ = true;
  std::uint16_t arming_ = 0, refused_ = 0;
};

class HostThreads : public testing::Test {
 protected:
  std::shared_ptr<WholeNumbersArm> number_arm = std::make_shared<WholeNumbersArm>("A1");
  std::shared_ptr<emulation::DisplayFirmware> number_display = std::make_shared<emulation::DisplayFirmware>("D1");
  tests::ThreadBusPlugs plugs{{number_arm, number_display}};
  UsbHost host{monotonicNs, [this](UsbPorts& ports, Clock clock) {
                 return std::make_unique<tests::ThreadBus>(ports, clock, plugs);
               }};

  static bool soon(const std::function<bool()>& done) {
    for (int i = 0; i < 10000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return done();
  }
};

TEST_F(HostThreads, ShareWholeValuesWhileDevicesComeAndGo) {
  ASSERT_TRUE(host.waitFor(1, 1, 10));
  UsbArm& arm = *host.arms()[0];
  UsbDisplay& display = *host.displays()[0];
  arm.setDeadline(0.1);  // a sanitizer takes its time
  std::atomic<bool> over{false};
  std::atomic<std::int64_t> torn{0}, samples{0};
  std::thread servo([&] {
    for (int k = 1; !over; ++k) {
      if (k % 50 == 0) arm.arm();
      const ArmSample sample = arm.sample();
      if (sample.valid) {
        ++samples;
        if ((sample.p_DF - Vec3::Constant(sample.p_DF.x())).norm() > 0 || (*sample.v_DF - sample.p_DF).norm() > 1e-12)
          ++torn;
      }
      if (k % 400 == 0) arm.signal(Signal::kStart);
      arm.commandForce(Vec3::Constant(1e-3 * (1 + k % 1000)));
      display.sample();
      display.command({k % 100 == 0, Vec2(1e-6 * (k % 1000), 0)});
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  });
  std::thread watchdog([&] {
    while (!over) {
      arm.stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(7));
    }
  });
  std::thread looks([&] {
    for (int k = 0; !over; ++k) {
      host.setEpoch(1000 * k);
      if (arm.calibration().size() == 2 && k % 16 == 0) arm.writeCalibration("base_x", 1e-3 * (k % 100));
      for (UsbArm* each : host.arms()) each->counts(), each->status(), each->calibrationSize();
      host.problems();
      host.strayFrames();
      host.waitFor(1, 1, 1e-3);
    }
  });
  for (int cycle = 0; cycle < 8; ++cycle) {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    plugs.plugged = ~static_cast<unsigned>(1 + cycle % 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    plugs.plugged = ~0u;
  }
  EXPECT_TRUE(soon([&] { return samples > 500 && number_arm->forces > 100; }));
  over = true;
  for (std::thread* thread : {&servo, &watchdog, &looks}) thread->join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(number_arm->torn, 0);
  EXPECT_EQ(arm.counts().bad + arm.counts().lost, 0);
  EXPECT_TRUE(host.problems().empty());
}

// The watchdog thread's command holds, whatever the servo's was about to do.
TEST_F(HostThreads, AStopFromAnotherThreadIsLimpUntilTheNextArming) {
  ASSERT_TRUE(host.waitFor(1, 1, 10));
  UsbArm& arm = *host.arms()[0];
  arm.setDeadline(0.1);
  std::atomic<bool> over{false}, stopped{false};
  std::int64_t after = 0;
  std::thread servo([&] {
    arm.arm();
    while (!over) {
      arm.commandForce(Vec3::Constant(1));
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  ASSERT_TRUE(soon([&] { return number_arm->forces > 20; }));
  std::thread watchdog([&] {
    arm.stop();
    stopped = true;
  });
  watchdog.join();
  const auto commands = [&] { return arm.counts().commands; };
  const std::int64_t sent = commands();
  ASSERT_TRUE(soon([&] { return commands() > sent + 2; }));  // what was on its way when it came
  after = number_arm->forces;
  ASSERT_TRUE(soon([&] { return commands() > sent + 50; }));
  EXPECT_EQ(number_arm->forces, after);
  over = true;
  servo.join();
}

}  // namespace
}  // namespace pincer::devices::usb
