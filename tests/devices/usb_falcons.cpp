// Two Novint Falcons on an emulated bus, under the real libusb: found, chosen by port or serial
// number, loaded with their image, rendering.
#include <gtest/gtest.h>

#include <fstream>

#include "pincer/devices/falcon/falcon_arm.h"
#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tests/devices/usb_bench.h"
#include "pincer/tests/emulation/falcon_gadget.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

constexpr std::size_t kImageSize = 1000;

class UsbFalcons : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
    bus = std::make_unique<emulation::EmulatedBus>();
    for (const char* serial : {"FA", "FB"})
      bus->add(falcons.emplace_back(std::make_shared<emulation::FalconGadget>(serial, kImageSize)));
    falcons[0]->falcon.counts = -150;
    falcons[1]->falcon.counts = -400;
    bus->runInRealTime();
    options.choice = tasks::DeviceChoice::kFalcon;
    options.firmware = folder / "image.bin";
    std::ofstream(options.firmware) << std::string(kImageSize, 'Z');
  }
  void TearDown() override {
    if (bus) bus->stopRealTime();
  }
  tasks::DeviceOptions with(std::vector<std::string> arms) const {
    tasks::DeviceOptions chosen = options;
    chosen.arms = std::move(arms);
    return chosen;
  }

  const TemporaryDirectory folder;
  std::vector<std::shared_ptr<emulation::FalconGadget>> falcons;
  std::unique_ptr<emulation::EmulatedBus> bus;
  tasks::DeviceOptions options;
};

TEST_F(UsbFalcons, AreListedByPortAndSerialNumber) {
  const auto places = devices::falcon::listFalcons();
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].port, "1-1");
  EXPECT_EQ(places[0].serial, "FA");
  EXPECT_EQ(places[1].port, "1-2");
  EXPECT_EQ(places[1].serial, "FB");
  const AppResult list = runPincer({"devices", "list", "--timeout", "0.1"});
  EXPECT_TRUE(contains(list.out, "1-2") && contains(list.out, "FB") && contains(list.out, "--arms 1-2")) << list.out;
}

// There was one Falcon, and no task for one finger.
TEST_F(UsbFalcons, AreWornByTwoFingersAtOnceEachByTheOneThatWasAskedFor) {
  const auto hand = tasks::openHandDevices(with({"FB", "1-1"}));
  hand->setEpoch(devices::usb::monotonicNs());
  ASSERT_TRUE(eventually([&] { return hand->arm(0).sample().valid && hand->arm(1).sample().valid; }));
  const auto angle = [&](int finger) {
    return (*devices::falcon::inverse(hand->arm(finger).sample().p_DF + Vec3(0, 0, devices::falcon::kCentre)))[0];
  };
  EXPECT_NEAR(angle(0), devices::falcon::angleOf(-400), 1e-6);
  EXPECT_NEAR(angle(1), devices::falcon::angleOf(-150), 1e-6);
  EXPECT_TRUE(contains(hand->describe()[0], "1-2 (serial FB)")) << hand->describe()[0];
  for (int finger = 0; finger < 2; ++finger) hand->arm(finger).arm();
  const auto pushed = [&](int finger) {
    for (int i = 0; i < 2; ++i) hand->arm(i).commandForce(Vec3(0, 0, i == finger ? 2 : 0));
    return falcons[finger == 0 ? 1 : 0]->falcon.torque0 != 0 && falcons[finger == 0 ? 0 : 1]->falcon.torque0 == 0;
  };
  EXPECT_TRUE(eventually([&] { return pushed(0); }));
  EXPECT_TRUE(eventually([&] { return pushed(1); }));
  hand->arm(1).stop();
  EXPECT_TRUE(eventually([&] {
    for (int i = 0; i < 2; ++i) hand->arm(i).commandForce(Vec3(0, 0, 2));
    return falcons[0]->falcon.torque0 == 0 && falcons[1]->falcon.torque0 != 0;
  }));
}

// Rest, the push through the gate, and what it says of a grip that is held.
TEST_F(UsbFalcons, AreFitWhenTheirGripFollowsThePushAndNotWhenItIsHeld) {
  std::vector<std::string> command = {"devices",        "test",    "FA",  "--devices", "falcon",     "--firmware",
                                      options.firmware, "--force", "0.3", "--yes",     "--watchdog", "50"};
  falcons[0]->falcon.free = true;
  const AppResult fit = runPincer(command);
  EXPECT_EQ(fit.exit_code, 0) << fit.out << fit.error;
  EXPECT_TRUE(contains(fit.out, "Verdict: fit for a session")) << fit.out;
  EXPECT_EQ(falcons[0]->falcon.torque0, 0);
  falcons[0]->falcon.free = false;
  const AppResult held = runPincer(command);
  EXPECT_EQ(held.exit_code, tasks::kExitDevice) << held.out;
  EXPECT_TRUE(contains(held.out, "moved it by 0.0 mm only")) << held.out;
  EXPECT_EQ(falcons[0]->falcon.torque0, 0);
}

TEST_F(UsbFalcons, StandWhereTheirCalibrationFilesSay) {
  std::ofstream(folder / "a.json") << R"({"device": "FA", "values": {"base_x": 0.01}})";
  tasks::DeviceOptions chosen = options;
  chosen.calibrations = {folder / "a.json"};
  const auto hand = tasks::openHandDevices(chosen);
  EXPECT_EQ(hand->base(0).offset_W, Vec3(0.01, 0, 0));
  EXPECT_EQ(hand->base(1).offset_W, Vec3::Zero());
}

TEST_F(UsbFalcons, ThatArentThereOrAreAskedForTwiceAreNamed) {
  const std::string missing = problemOf([&] { tasks::openHandDevices(with({"FB", "FC"})); });
  EXPECT_TRUE(contains(missing, "\"FC\"") && contains(missing, "1-1 (serial FA), 1-2 (serial FB)")) << missing;
  const std::string twice = problemOf([&] { tasks::openHandDevices(with({"FB", "1-2"})); });
  EXPECT_TRUE(contains(twice, "same Falcon, 1-2 (serial FB)")) << twice;
  bus->unplug(0);
  const std::string one = problemOf([&] { tasks::openHandDevices(options); });
  EXPECT_TRUE(contains(one, "2 Novint Falcons") && contains(one, "found: 1-2 (serial FB)")) << one;
}

TEST_F(UsbFalcons, WithoutAnImageSayWhichOneNeedsIt) {
  tasks::DeviceOptions without = options;
  without.firmware.clear();
  const std::string none = problemOf([&] { tasks::openHandDevices(without); });
  EXPECT_TRUE(contains(none, "USB port 1-1") && contains(none, "--firmware")) << none;
  emulation::denyUsbfs(true);
  const std::string denied = problemOf([&] { tasks::openHandDevices(options); });
  emulation::denyUsbfs(false);
  EXPECT_TRUE(contains(denied, "udev rule") && contains(denied, "1-1")) << denied;
}

}  // namespace
}  // namespace pincer::tests
