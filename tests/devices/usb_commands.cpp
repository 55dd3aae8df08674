// `pincer devices` and sessions as their user meets them, with arms on an emulated bus in real time.
#include <gtest/gtest.h>

#include <fstream>

#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tests/devices/usb_bench.h"
#include "pincer/tests/emulation/firmware.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

class UsbCommands : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string obstacle = emulation::EmulatedBus::obstacle(); !obstacle.empty()) GTEST_SKIP() << obstacle;
    bus = std::make_unique<emulation::EmulatedBus>();
    for (const char* serial : {"A1", "A2"})
      bus->add(arms.emplace_back(std::make_shared<emulation::ArmFirmware>(serial)));
  }
  void TearDown() override {
    if (bus) bus->stopRealTime();
  }
  static tasks::DeviceOptions session() {
    tasks::DeviceOptions options;
    options.choice = tasks::DeviceChoice::kUsb;
    options.needs_displays = false;
    return options;
  }
  double kept(std::size_t arm, std::size_t index) {
    return bus->device(static_cast<int>(arm)).with([&] { return arms[arm]->calibration()[index].second; });
  }
  static constexpr std::size_t kBaseX = 0, kBaseTurn = 3;

  const TemporaryDirectory folder;
  std::vector<std::shared_ptr<emulation::ArmFirmware>> arms;
  std::unique_ptr<emulation::EmulatedBus> bus;
};

// The joints bore what the gate's constants allowed, whatever the arm told of them.
TEST_F(UsbCommands, DevicesTestKeepsToTheTorquesOfTheJoints) {
  arms[0]->tellPeakTorque(Vec3::Constant(0.02));
  std::atomic<double> most{0}, load{0};
  bus->runInRealTime([&] {
    bus->device(0).with([&] {
      const Vec3 f_D = arms[0]->force();
      most = std::max(most.load(), f_D.norm());
      load = std::max(load.load(), (arms[0]->plant().sample().J->transpose() * f_D).cwiseAbs().maxCoeff());
    });
  });
  const AppResult test =
      runPincer({"devices", "test", "A1", "--force", "0.5", "--seconds", "1", "--watchdog", "100", "--yes"});
  EXPECT_TRUE(contains(test.out, "pincer emu arm A1")) << test.out << test.error;
  EXPECT_GT(most, 0.02) << "it pushed: " << test.out;
  EXPECT_TRUE(contains(test.out, "Verdict: ") && contains(test.out, "age of a sample")) << test.out;
  EXPECT_LE(load, 0.02 * 1.01) << "the arm moved between the command and this look";
}

TEST_F(UsbCommands, CalibrationIsKeptInTheDeviceAndReadByTheNextSession) {
  bus->runInRealTime();
  const std::string file = folder / "A1.json";
  const AppResult set =
      runPincer({"devices", "calibrate", "A1", "--set", "base_x=0.012", "--set", "base_turn=-0.1", "--save", file});
  ASSERT_EQ(set.exit_code, 0) << set.error;
  EXPECT_TRUE(contains(set.out, "base_x               0.012")) << set.out;
  EXPECT_EQ(kept(0, kBaseX), 0.012);
  EXPECT_EQ(kept(0, kBaseTurn), -0.1);
  {
    const auto hand = tasks::openHandDevices(session());
    EXPECT_EQ(hand->base(0).offset_W, Vec3(0.012, 0, 0));
    EXPECT_EQ(hand->base(0).turn, -0.1);
    EXPECT_EQ(hand->base(1).offset_W, Vec3::Zero());
    EXPECT_TRUE(contains(hand->describe()[0], "12.0, 0.0, 0.0 mm")) << hand->describe()[0];
  }
  ASSERT_EQ(runPincer({"devices", "calibrate", "A1", "--set", "base_x=0"}).exit_code, 0);
  tasks::DeviceOptions from_file = session();
  from_file.calibrations = {file};
  EXPECT_EQ(tasks::openHandDevices(from_file)->base(0).offset_W, Vec3(0.012, 0, 0))
      << "a file counts over what the arm keeps";
  ASSERT_EQ(runPincer({"devices", "calibrate", "A1", "--load", file}).exit_code, 0);
  EXPECT_EQ(kept(0, kBaseX), 0.012);
}

// One wrong among several: the right ones had been written before it was found.
TEST_F(UsbCommands, CalibrateNamesWhatIsWrongBeforeItWritesAnything) {
  bus->runInRealTime();
  const auto refused = [&](std::vector<std::string> words, std::initializer_list<const char*> parts) {
    // that the device has no gain only it knows
    const bool is_usage = words.front() == "--set" && words.back() != "gain=1";
    const int expected = is_usage ? 2 : 3;
    words.insert(words.begin(), {"devices", "calibrate", "A1", "--set", "base_x=0.5"});
    const AppResult result = runPincer(words);
    EXPECT_EQ(result.exit_code, expected) << result.out;
    for (const char* part : parts) EXPECT_TRUE(contains(result.error, part)) << part << ": " << result.error;
  };
  refused({"--set", "base_y"}, {"\"base_y\"", "NAME=VALUE"});
  refused({"--set", "base_y=far"}, {"\"base_y=far\"", "NAME=VALUE"});
  refused({"--set", "base_y=nan"}, {"base_y = nan", "[-10, 10]"});
  refused({"--set", "base_y=11"}, {"base_y = 11", "[-10, 10]", "metres"});
  refused({"--set", "gain=1"}, {"\"gain\"", "base_turn, base_x, base_y, base_z"});
  refused({"--load", folder / "none.json"}, {"none.json"});
  std::ofstream(folder / "other.json") << R"({"device": "A2", "values": {"base_x": 0.01}})";
  refused({"--load", folder / "other.json"}, {"calibration of A2", "not of A1"});
  EXPECT_EQ(kept(0, kBaseX), 0);
}

TEST_F(UsbCommands, ASessionRefusesAnArmWhoseOwnCalibrationIsOutOfRange) {
  arms[1]->calibration()[kBaseX].second = 40;
  bus->runInRealTime();
  const std::string why = problemOf([&] { tasks::openHandDevices(session()); });
  EXPECT_TRUE(contains(why, "A2") && contains(why, "base_x = 40") && contains(why, "pincer devices calibrate A2"))
      << why;
}

TEST_F(UsbCommands, AnArmThatKeepsNoCalibrationStandsInItsPlace) {
  for (const auto& arm : arms) arm->calibration().clear();
  bus->runInRealTime();
  EXPECT_EQ(tasks::openHandDevices(session())->base(1).offset_W, Vec3::Zero());
  const AppResult calibrate = runPincer({"devices", "calibrate", "A1"});
  EXPECT_EQ(calibrate.exit_code, 4);
  EXPECT_TRUE(contains(calibrate.error, "A1 keeps no calibration values")) << calibrate.error;
}

TEST_F(UsbCommands, ASessionNamesTheArmThatIsntThere) {
  bus->runInRealTime();
  tasks::DeviceOptions options = session();
  options.arms = {"A1", "A7"};
  const std::string why = problemOf([&] { tasks::openHandDevices(options); });
  EXPECT_TRUE(contains(why, "A7") && contains(why, "pincer devices list")) << why;
}

}  // namespace
}  // namespace pincer::tests
