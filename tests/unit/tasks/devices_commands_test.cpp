// Devices as their user meets them, on a machine that has none.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "contact/error.h"
#include "tasks/servo/device_calibration.h"
#include "tasks/servo/hand_devices.h"
#include "tests/support/error_of.h"
#include "tests/support/run_app.h"
#include "tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

using tasks::DeviceChoice;
using tasks::DeviceError;
using tasks::DeviceOptions;

void writeText(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

TEST(DevicesCommand, ListSaysThatNothingIsThere) {
  const AppResult result = runPincer({"devices", "list", "--timeout", "0.1"});
  EXPECT_EQ(result.exit_code, 0) << result.error;
  EXPECT_TRUE(contains(result.out, "1209:0001")) << result.out;
}

TEST(DevicesCommand, TestAndCalibrateNameTheRemedyWhenThereIsNoDevice) {
  const AppResult test = runPincer({"devices", "test", "ARM9"});
  EXPECT_EQ(test.exit_code, 4);
  EXPECT_TRUE(contains(test.error, "ARM9") && contains(test.error, "pincer devices list")) << test.error;
  const AppResult calibrate = runPincer({"devices", "calibrate", "ARM9"});
  EXPECT_EQ(calibrate.exit_code, 4);
  EXPECT_TRUE(contains(calibrate.error, "pincer devices list")) << calibrate.error;
}

TEST(DevicesCommand, ASessionOnMissingDevicesEndsBeforeItBegins) {
  const TemporaryDirectory folder;
  const std::string out = folder / "out";
  const AppResult usb = runPincer({"run", "sphere-pickup", "--devices", "usb", "--out", out});
  EXPECT_EQ(usb.exit_code, 4);
  EXPECT_TRUE(contains(usb.error, "2 arms") && contains(usb.error, "found: none")) << usb.error;
  EXPECT_FALSE(std::ifstream(out + "/session.db").good());
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "mouse", "--out", out}).exit_code, 3);  // needs --view
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "falcon", "--out", out}).exit_code, 4);
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "replay", "--out", out}).exit_code, 4);
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "abacus", "--out", out}).exit_code, 2);
}

TEST(DeviceChoiceNames, AreKnown) {
  EXPECT_EQ(tasks::deviceChoiceOf("usb"), DeviceChoice::kUsb);
  EXPECT_EQ(tasks::deviceChoiceOf("replay"), DeviceChoice::kReplay);
  EXPECT_THROW(tasks::deviceChoiceOf("abacus"), InputError);
}

TEST(DeviceCalibration, IsReadBackAsItWasWritten) {
  const TemporaryDirectory folder;
  const std::string path = folder / "a.json";
  tasks::writeCalibration({"ARM1", {{"base_x", -0.25}, {"yaw", 0.1}}}, path);
  const auto back = tasks::readCalibration(path);
  EXPECT_EQ(back.serial, "ARM1");
  EXPECT_EQ(back.values, (std::map<std::string, double>{{"base_x", -0.25}, {"yaw", 0.1}}));
}

TEST(DeviceCalibration, NamesWhatIsWrongInTheFile) {
  const TemporaryDirectory folder;
  const std::string path = folder / "a.json";
  writeText(path, "{ \"device\": \"ARM1\",\n  \"values\": { \"base_x\": 12 } }");
  const std::string range = errorOf([&] { tasks::readCalibration(path); });
  EXPECT_TRUE(contains(range, ":2:") && contains(range, "base_x")) << range;
  writeText(path, "{ \"device\": \"ARM1\", \"value\": {} }");
  EXPECT_THROW(tasks::readCalibration(path), InputError);
  EXPECT_THROW(tasks::checkCalibrationValue("x", 11), InputError);
}

DeviceOptions replayOf(const std::string& path) {
  DeviceOptions options;
  options.choice = DeviceChoice::kReplay;
  options.recording = path;
  return options;
}

TEST(ReplayHand, MovesAsTheRecordedFingersDid) {
  const TemporaryDirectory folder;
  const std::string path = folder / "samples.csv";
  writeText(path,
            "trial,time_s,f0_p_WF_x_m,f0_p_WF_y_m,f0_p_WF_z_m,f1_p_WF_x_m,f1_p_WF_y_m,f1_p_WF_z_m\n"
            "3,0,0,0,0,1,0,0\n3,1,0.1,0,0,1,0,0.2\n4,0,9,9,9,9,9,9\n");
  const auto hand = tasks::openHandDevices(replayOf(path));
  hand->setBase(0, Vec3(0.05, 0, 0), Quat::Identity());
  hand->setBase(1, Vec3(1, 0, 0), Quat(Eigen::AngleAxisd(3.14159265358979 / 2, Vec3::UnitX())));
  hand->advanceTo(0.5);
  EXPECT_NEAR((hand->arm(0).sample().p_DF - Vec3(0, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((hand->arm(1).sample().p_DF - Vec3(0, 0.1, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(hand->display(0), nullptr);
  hand->advanceTo(1.1);
  EXPECT_FALSE(hand->arm(0).sample().valid) << "the recording's first trial has ended";
}

TEST(ReplayHand, NamesWhatIsWrongInTheFile) {
  const TemporaryDirectory folder;
  const std::string path = folder / "samples.csv";
  EXPECT_THROW(tasks::openHandDevices(replayOf(path)), InputError);
  writeText(path, "time_s,f0_p_WF_x_m\n");
  EXPECT_TRUE(contains(errorOf([&] { tasks::openHandDevices(replayOf(path)); }), "columns f0_p_WF_x_m"));
  writeText(path,
            "time_s,f0_p_DF_x_m,f0_p_DF_y_m,f0_p_DF_z_m,f1_p_DF_x_m,f1_p_DF_y_m,f1_p_DF_z_m\n"
            "0,0,0,0,0,0,0\n1,0,zero,0,0,0,0\n");
  EXPECT_TRUE(contains(errorOf([&] { tasks::openHandDevices(replayOf(path)); }), ":3: \"zero\""));
  EXPECT_THROW(tasks::openHandDevices(replayOf("")), DeviceError);
}

}  // namespace
}  // namespace pincer::tests
