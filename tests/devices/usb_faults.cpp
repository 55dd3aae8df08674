// Every kind of transfer fault at every transfer, in both directions: nothing
// unsound is believed, and no force stays on.
#include <gtest/gtest.h>

#include "pincer/tests/devices/usb_scenarios.h"

namespace pincer::tests {
namespace {

using devices::usb::UsbHost;
using emulation::TransferFault;

class UsbFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
  }
};

TEST_F(UsbFaults, AThousandOfEveryKindWhileStreaming) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  FaultyServo servo(bench, *firmware, host);
  ASSERT_TRUE(servo.find());
  const int faults = 2 * emulation::kTransferFaults * 40;
  injectFaults(bench, servo, faults);
  EXPECT_GE(bench.bus.device(0).faultsDone(), 1000) << "one may replace another that is still due";
  EXPECT_EQ(servo.unsound(), 0);
  EXPECT_EQ(servo.stuck(), 0);
  const auto counts = servo.arm().counts();
  EXPECT_GT(counts.bad, 0);
  EXPECT_GT(counts.duplicates, 0);
  EXPECT_GT(counts.late, 0);
  EXPECT_GT(counts.lost, 0);
  ASSERT_TRUE(eventually([&] {
    servo.tick();
    return servo.arm().sample().valid && servo.arm().counts().accepted > counts.accepted + 20;
  })) << "afterwards all is as before";
  RecordProperty("faults", static_cast<int>(bench.bus.device(0).faultsDone()));
  RecordProperty("rearmed", servo.trips());
}

// From the first transfer after plugging in on: each kind at each of the first transfers of each
// direction. The device is found all the same.
TEST_F(UsbFaults, OfEveryKindAtEveryTransferOfTheIntroduction) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  FaultyServo servo(bench, *firmware, host);
  ASSERT_TRUE(servo.find());
  for (int k = 0; k < emulation::kTransferFaults; ++k) {
    for (int index = 0; index < 5; ++index) {
      bench.bus.unplug(0);
      ASSERT_TRUE(eventually([&] { return servo.arm().state() == devices::DeviceState::kConnecting; }));
      bench.bus.prepare(0);
      bench.bus.device(0).injectAt(index, true, faultKind(k));
      if (index < 2) bench.bus.device(0).injectAt(index, false, faultKind(k));
      bench.bus.plug(0);
      ASSERT_TRUE(eventually([&] {
        servo.tick();
        return servo.arm().sample().valid;
      })) << nameOf(faultKind(k))
          << " at transfer " << index;
    }
  }
  EXPECT_EQ(servo.unsound(), 0);
  EXPECT_EQ(servo.stuck(), 0);
}

TEST_F(UsbFaults, ADeviceThatOnlyFailsIsGivenUpAndComesBackWhenPluggedInAgain) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  FaultyServo servo(bench, *firmware, host);
  ASSERT_TRUE(servo.find());
  for (int i = 0; i < 100; ++i) bench.bus.device(0).injectAt(i, true, TransferFault::kProtocolError);
  ASSERT_TRUE(eventually([&] {
    bench.advance(1e-3);
    return servo.arm().state() == devices::DeviceState::kConnecting;
  }));
  EXPECT_FALSE(servo.arm().sample().valid);
  bench.bus.unplug(0);
  bench.bus.plug(0);
  ASSERT_TRUE(eventually([&] {
    bench.advance(1e-3);
    return servo.arm().sample().valid;
  }));
}

TEST_F(UsbFaults, ADeviceThatIsSilentIsNamed) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  bench.bus.device(0).with([&] { firmware->setSilent(true); });
  UsbHost host(bench.clock());
  ASSERT_TRUE(eventually([&] {
    bench.advance(10e-3);
    return !host.problems().empty();
  }));
  EXPECT_NE(host.problems()[0].find("doesn't say who it is"), std::string::npos);
}

}  // namespace
}  // namespace pincer::tests
