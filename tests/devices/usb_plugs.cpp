// Plugged in and pulled out over and over: the host takes every device back, and keeps nothing of those that are gone.
#include <gtest/gtest.h>

#include <cstdlib>

#include "pincer/tests/devices/usb_scenarios.h"

namespace pincer::tests {
namespace {

using devices::usb::UsbHost;

class UsbPlugs : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
  }
};

TEST_F(UsbPlugs, CyclesLeakNeitherDescriptorsNorMemory) {
  const int cycles = std::getenv("PINCER_LONG_TESTS") != nullptr ? 1000 : 20;
  UsbBench bench;
  bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  const PlugCycles result = plugCycles(bench, *host.arms()[0], cycles);
  EXPECT_EQ(result.done, cycles);
  EXPECT_LE(result.descriptors, 0);
  // umockdev itself keeps this much of every device that it ever showed; libusb's and ours would be kilobytes.
  EXPECT_LE(result.bytes, cycles < 100 ? 2048 : 256);
  EXPECT_EQ(host.arms().size(), 1u);
  RecordProperty("bytes_per_cycle", std::to_string(result.bytes));
}

TEST_F(UsbPlugs, PulledOutInTheMiddleOfTransfersAndBeforeItSaidWhoItIs) {
  UsbBench bench;
  bench.addArm("A1");
  for (int i = 0; i < 10; ++i) {
    UsbHost host(bench.clock());
    bench.advance(1e-3);
    bench.bus.unplug(0);
    bench.bus.plug(0);
    ASSERT_TRUE(findAll(bench, host, 1, 0)) << i;
  }
}

}  // namespace
}  // namespace pincer::tests
