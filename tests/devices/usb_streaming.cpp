// Devices on an emulated bus under the real libusb: found, streaming, commanded, unplugged, plugged in again.
#include <gtest/gtest.h>

#include "pincer/devices/gate/force_gate.h"
#include "pincer/tests/devices/usb_bench.h"

namespace pincer::tests {
namespace {

using devices::DeviceState;
using devices::usb::UsbHost;

class Usb : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
  }
};

TEST_F(Usb, FindsTwoArmsAndTwoDisplays) {
  UsbBench bench;
  bench.addArm("A1"), bench.addArm("A2"), bench.addDisplay("D1"), bench.addDisplay("D2");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 2, 2));
  ASSERT_EQ(host.arms().size(), 2u);
  ASSERT_EQ(host.displays().size(), 2u);
  EXPECT_EQ(host.arms()[1]->identity(), "pincer emu arm A2");
  EXPECT_NEAR(host.arms()[0]->capabilities().peak_force, 8.5, 1e-6);
  EXPECT_NEAR(host.displays()[0]->capabilities().resolution, 53e-6, 1e-9);
  EXPECT_TRUE(host.problems().empty());
}

TEST_F(Usb, SaysAtOnceThatNothingIsPluggedIn) {
  UsbBench bench;
  UsbHost host(bench.clock());
  EXPECT_FALSE(host.waitFor(1, 0, 60));
  EXPECT_TRUE(host.problems().empty());
}

// The servo of two hands, tick by tick in virtual time: every tick's command is answered in it, nothing is lost.
TEST_F(Usb, CarriesTwoArmsAndTwoDisplaysAtOneKilohertzWithoutLosingAFrame) {
  UsbBench bench;
  const auto first = bench.addArm("A1"), second = bench.addArm("A2");
  const auto left = bench.addDisplay("D1"), right = bench.addDisplay("D2");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 2, 2));
  const auto arms = host.arms();
  const auto displays = host.displays();
  for (auto* arm : arms) arm->arm();
  const int ticks = 1000;
  std::array<std::int64_t, 4> before{first->commands(), second->commands(), left->commands(), right->commands()};
  for (int i = 1; i <= ticks; ++i) {
    bench.advance(1e-3);
    for (auto* arm : arms) {
      EXPECT_TRUE(arm->sample().valid);
      arm->commandForce(Vec3(0.1, 0, 1e-3 * i));
    }
    for (auto* display : displays) display->command({false, Vec2(1e-6 * i, 0)});
    ASSERT_TRUE(eventually([&] {
      return bench.bus.device(0).with([&] { return first->commands(); }) - before[0] >= i &&
             bench.bus.device(1).with([&] { return second->commands(); }) - before[1] >= i &&
             bench.bus.device(2).with([&] { return left->commands(); }) - before[2] >= i &&
             bench.bus.device(3).with([&] { return right->commands(); }) - before[3] >= i;
    })) << "tick "
        << i;
  }
  EXPECT_NEAR(first->force().z(), 1.0, 1e-6);  // the wire's step
  EXPECT_NEAR(second->force().x(), 0.1, 1e-6);
  EXPECT_EQ(first->missedDeadlines() + second->missedDeadlines(), 0);
  for (auto* arm : arms) {
    EXPECT_EQ(arm->counts().lost, 0);
    EXPECT_EQ(arm->counts().bad + arm->counts().duplicates + arm->counts().late, 0);
    EXPECT_GE(arm->counts().accepted, ticks);
  }
  for (auto* display : displays) EXPECT_EQ(display->counts().lost, 0);
  EXPECT_EQ(first->badFrames() + second->badFrames() + left->badFrames() + right->badFrames(), 0);
}

TEST_F(Usb, AnArmTakesNoForceBeforeItIsArmed) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  const auto send = [&](const Vec3& f) {
    const auto before = bench.bus.device(0).with([&] { return firmware->commands(); });
    arm->commandForce(f);
    ASSERT_TRUE(eventually([&] { return bench.bus.device(0).with([&] { return firmware->commands(); }) > before; }));
  };
  send(Vec3(1, 0, 0));
  EXPECT_EQ(firmware->force(), Vec3::Zero());
  arm->arm();
  send(Vec3(1, 0, 0));
  EXPECT_EQ(firmware->force(), Vec3(1, 0, 0));
  arm->stop();
  ASSERT_TRUE(eventually([&] { return bench.bus.device(0).with([&] { return firmware->limp(); }); }));
  EXPECT_EQ(firmware->force(), Vec3::Zero());
  send(Vec3(1, 0, 0));
  EXPECT_EQ(firmware->force(), Vec3::Zero()) << "stopped arms stay limp until they are armed again";
  arm->arm();
  send(Vec3(1, 0, 0));
  EXPECT_EQ(firmware->force(), Vec3(1, 0, 0));
}

// A stopped computer, a hung program and a SIGSTOP have one thing in common: no command comes.
TEST_F(Usb, AnArmThatHearsNothingGoesLimpWithinFiveMillisecondsAndStaysSo) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  arm->arm();
  arm->commandForce(Vec3(0, 0, 2));
  ASSERT_TRUE(eventually([&] { return bench.bus.device(0).with([&] { return firmware->force().z() == 2; }); }));
  for (int i = 0; i < 3; ++i) bench.advance(1e-3);
  EXPECT_EQ(firmware->force().z(), 2);
  bench.advance(1e-3);
  EXPECT_EQ(firmware->force(), Vec3::Zero());
  EXPECT_EQ(firmware->missedDeadlines(), 1);
  ASSERT_TRUE(eventually([&] {
    bench.advance(1e-3);
    return !arm->sample().valid;
  })) << "the host must see that its arm gave up";
  arm->commandForce(Vec3(0, 0, 2));
  for (int i = 0; i < 20; ++i) bench.advance(1e-3), std::this_thread::sleep_for(std::chrono::microseconds(200));
  EXPECT_EQ(firmware->force(), Vec3::Zero());
  arm->arm();
  EXPECT_TRUE(arm->sample().valid);
}

// The deadline began when the command was sent, not when it was asked for: a stall of program
// and USB thread kept the force for longer.
TEST_F(Usb, ACommandThatWasHeldUpDiesWhenItWouldHaveAnyway) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  std::atomic<bool> held{false};
  UsbHost host([&, servo = std::this_thread::get_id()] {
    while (held && std::this_thread::get_id() != servo) std::this_thread::sleep_for(std::chrono::microseconds(100));
    return bench.now_ns.load();
  });
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  const auto force = [&] { return bench.bus.device(0).with([&] { return firmware->force().z(); }); };
  const auto millisecondsOfForce = [&](int held_up) {
    arm->arm();
    held = true;
    arm->commandForce(Vec3(0, 0, 2));
    for (int i = 0; i < held_up; ++i) bench.advance(1e-3);
    held = false;
    const bool came = eventually([&] { return force() == 2; });
    int ms = held_up;
    for (; came && force() > 0 && ms < 20; ++ms) bench.advance(1e-3);
    return came ? ms : -1;
  };
  for (const int held_up : {0, 1, 2, 3})
    EXPECT_EQ(millisecondsOfForce(held_up), 4) << "held up for " << held_up << " ms";
  const auto commands = firmware->commands();
  arm->arm();
  held = true;
  arm->commandForce(Vec3(0, 0, 2));
  for (int i = 0; i < 5; ++i) bench.advance(1e-3);
  held = false;
  arm->commandForce(Vec3(0, 0, 1));  // the next goes out
  ASSERT_TRUE(eventually([&] { return force() == 1; }));
  EXPECT_EQ(firmware->commands(), commands + 1) << "older than its deadline: never sent";
}

TEST_F(Usb, UnpluggedArmIsZeroForceInTheNextTickAndStreamsAgainButForcelessWhenPluggedIn) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  devices::GateState gate;
  devices::arm(gate);
  arm->arm();
  const devices::GateLimits limits;
  const auto tick = [&] {
    bench.advance(1e-3);
    devices::GateInput in;
    in.sample = arm->sample();
    in.now = 1e-9 * static_cast<double>(bench.now_ns);
    in.f_D = Vec3(0, 0, 0.5);
    const Vec3 f = devices::gateForce(limits, in, gate);
    arm->commandForce(f);
    return f;
  };
  // Bench time may run ahead of the USB thread on a busy machine: then the gate rightly
  // trips on an old sample, and is armed again.
  const auto armedTick = [&] {
    if (!gate.armed) devices::arm(gate), arm->arm();
    return tick();
  };
  ASSERT_TRUE(eventually([&] { return armedTick().z() > 0.1; }));
  bench.bus.unplug(0);
  ASSERT_TRUE(eventually([&] { return arm->state() == DeviceState::kConnecting; }));
  EXPECT_EQ(tick(), Vec3::Zero()) << "the tick after the unplugging was seen";
  EXPECT_EQ(gate.trip, devices::Trip::kInvalidSample);
  EXPECT_EQ(firmware->force().norm() > 0 ? tick() : Vec3::Zero(), Vec3::Zero());
  bench.bus.plug(0);
  const std::int64_t plugged = bench.now_ns;
  ASSERT_TRUE(eventually([&] {
    tick();
    return arm->sample().valid;
  }));
  RecordProperty("replug_ms_virtual", std::to_string(1e-6 * static_cast<double>(bench.now_ns - plugged)));
  for (int i = 0; i < 50; ++i) tick(), std::this_thread::sleep_for(std::chrono::microseconds(100));
  EXPECT_EQ(firmware->force(), Vec3::Zero()) << "force came back without an operator";
  ASSERT_TRUE(eventually([&] {
    armedTick();
    return bench.bus.device(0).with([&] { return firmware->force().z(); }) > 0.01;
  }));
  EXPECT_EQ(arm->counts().unplugs, 1);
  EXPECT_EQ(arm->counts().connects, 2);
}

TEST_F(Usb, ADisplayParksWhenTheProgramFallsSilent) {
  UsbBench bench;
  const auto firmware = bench.addDisplay("D1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 0, 1));
  auto* display = host.displays()[0];
  EXPECT_TRUE(display->command({false, Vec2(0.05, 0)})) << "out of reach";
  EXPECT_FALSE(display->command({false, Vec2(0.005, 0)}));
  ASSERT_TRUE(eventually([&] { return bench.bus.device(0).with([&] { return !firmware->parked(); }); }));
  for (int i = 0; i < 60; ++i) bench.advance(1e-3);
  EXPECT_FALSE(firmware->parked());
  for (int i = 0; i < 60; ++i) bench.advance(1e-3);
  EXPECT_TRUE(firmware->parked());
  ASSERT_TRUE(eventually([&] { return display->sample().place_L && display->sample().place_L->x() > 1e-3; }));
}

// A value was written to the place of its name among the names, whatever index the device keeps it at.
TEST_F(Usb, ReadsAndWritesTheDevicesCalibration) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  const auto whole = [&] {
    bench.advance(1e-3);
    return arm->calibration().size() == 4;
  };
  ASSERT_TRUE(eventually(whole));
  EXPECT_FALSE(arm->writeCalibration("gain", 1)) << "it keeps no such value";
  ASSERT_TRUE(arm->writeCalibration("base_turn", 0.125));
  ASSERT_TRUE(eventually([&] { return whole() && arm->calibration()["base_turn"] == 0.125; }));
  EXPECT_EQ(firmware->calibration()[3], std::pair(std::string("base_turn"), 0.125));
  EXPECT_EQ(firmware->calibration()[0], std::pair(std::string("base_x"), 0.0));
  EXPECT_EQ(firmware->badFrames(), 0);
}

TEST_F(Usb, ADeviceThatReportsAFaultIsNoLongerReady) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  bench.bus.device(0).with([&] { firmware->setState(DeviceState::kFaulted, devices::usb::kEmergencyStop); });
  ASSERT_TRUE(eventually([&] {
    bench.advance(1e-3);
    return arm->state() == DeviceState::kFaulted;
  }));
  EXPECT_FALSE(arm->sample().valid);
  EXPECT_EQ(devices::usb::describeFaults(arm->status().faults), "emergency stop");
}

// It was read in the order of the transfers' places, not of their coming: every other pair of frames counted as late.
TEST_F(Usb, TransfersThatCompleteTogetherAreReadInTheOrderOfTheirCompletion) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  auto accepted = arm->counts().accepted;
  for (int round = 0; round < 100; ++round) {
    const int frames = 2 + round % 4;  // so that the next to come back is now the one, now the other
    bench.bus.device(0).with([&] {
      for (int i = 0; i < frames; ++i) firmware->advance(2e-3);
    });
    bench.bus.device(0).advance(1e-4);
    ASSERT_TRUE(eventually([&] { return arm->counts().accepted >= accepted + frames; })) << "round " << round;
    accepted = arm->counts().accepted;
  }
  EXPECT_EQ(arm->counts().late, 0);
  EXPECT_EQ(arm->counts().lost, 0);
}

// A minute of two hands on a busy machine lost four frames: two transfers waited for the
// device, which keeps sixteen frames at the most.
TEST_F(Usb, AProgramThatGetsNoProcessorForAWhileLosesNoFrame) {
  UsbBench bench;
  bench.addArm("A1");
  std::atomic<bool> held{false};
  // the USB thread asks for the time: where the machine holds it up
  UsbHost host([&, servo = std::this_thread::get_id()] {
    while (held && std::this_thread::get_id() != servo) std::this_thread::sleep_for(std::chrono::microseconds(100));
    return bench.now_ns.load();
  });
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  const auto before = arm->counts();
  held = true;
  arm->commandForce(Vec3::Zero());  // wakes it
  for (int i = 0; i < 60; ++i) bench.advance(1e-3);
  held = false;
  ASSERT_TRUE(eventually([&] { return arm->counts().accepted >= before.accepted + 30; }))
      << "a frame each 1.4 ms at the most";
  EXPECT_EQ(arm->counts().lost, 0);
  EXPECT_EQ(arm->counts().late, 0);
  EXPECT_EQ(arm->counts().duplicates, 0);
}

TEST_F(Usb, AnArmWhoseLinkageIsToldSaysHowItsJointsBearAForce) {
  UsbBench bench;
  const auto firmware = bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  ASSERT_TRUE(arm->capabilities().peak_torque);
  EXPECT_NEAR((*arm->capabilities().peak_torque - firmware->plant().peakTorque()).norm(), 0, 1e-4) << "the wire's step";
  ASSERT_TRUE(arm->sample().J);
  EXPECT_NEAR((*arm->sample().J - *firmware->plant().sample().J).norm(), 0, 1e-4)
      << "angles from a place in whole nanometres";
}

// A state that was held up on its way is seen as old, though it arrives now.
TEST_F(Usb, AHeldUpStateIsAsOldAsItIs) {
  UsbBench bench;
  bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(findAll(bench, host, 1, 0));
  auto* arm = host.arms()[0];
  const auto accepted = arm->counts().accepted;
  // the device's clock stands still: as if its frames were 10 ms under way
  for (int i = 0; i < 10; ++i) bench.now_ns += 1'000'000;
  bench.bus.advance(2e-3);
  ASSERT_TRUE(eventually([&] { return arm->counts().accepted > accepted; }));
  EXPECT_LT(arm->sample().time, 1e-9 * static_cast<double>(bench.now_ns) - 7e-3);
}

TEST_F(Usb, NamesWhatKeepsItFromOpeningADevice) {
  UsbBench bench;
  emulation::denyUsbfs(true);
  bench.addArm("A1");
  {
    UsbHost host(bench.clock());
    EXPECT_FALSE(host.waitFor(1, 0, 10));
    ASSERT_EQ(host.problems().size(), 1u);
    EXPECT_NE(host.problems()[0].find("udev rule"), std::string::npos) << host.problems()[0];
  }
  emulation::denyUsbfs(false);
}

TEST_F(Usb, RefusesADeviceWhoseEndpointDescriptorIsMissing) {
  UsbBench bench;
  bench.addArm("A1");
  bench.bus.unplug(0);
  // bNumEndpoints says 2, but the configuration ends after the first.
  bench.bus.setDescriptors(0, "12010002000000400912010000010102030109021900010100C0320904000002FF00000007050103400001");
  bench.bus.plug(0);
  UsbHost host(bench.clock());
  EXPECT_FALSE(host.waitFor(1, 0, 10));
  ASSERT_EQ(host.problems().size(), 1u);
  EXPECT_NE(host.problems()[0].find("endpoint"), std::string::npos) << host.problems()[0];
}

TEST_F(Usb, TwoDevicesWithOneSerialNumberAreNamed) {
  UsbBench bench;
  bench.addArm("A1"), bench.addArm("A1");
  UsbHost host(bench.clock());
  ASSERT_TRUE(eventually([&] {
    bench.advance(1e-3);
    return !host.problems().empty();
  }));
  EXPECT_NE(host.problems()[0].find("A1"), std::string::npos);
}

}  // namespace
}  // namespace pincer::tests
