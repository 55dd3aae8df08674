// Devices as their user meets them, on a machine that has none.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "pincer/contact/error.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/run/servo/device_calibration.h"
#include "pincer/tasks/run/servo/hand_devices.h"
#include "pincer/tasks/run/session_store.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

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
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "mouse", "--out", out}).exit_code, 2);  // needs --view
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "falcon", "--out", out}).exit_code, 4);
  EXPECT_EQ(runPincer({"run", "sphere-pickup", "--devices", "replay", "--out", out}).exit_code, 2);
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

TEST(ReplayHand, ReplaysASessionsStoreAsItIs) {
  const TemporaryDirectory folder;
  const std::string path = folder / "session.db";
  EXPECT_THROW(tasks::openHandDevices(replayOf(path)), InputError);
  {
    tasks::SessionOptions store;
    store.block_when_full = true;
    tasks::SessionWriter writer = tasks::SessionWriter::create(path, tasks::SessionInfo{}, store);
    for (int i = 0; i < 20; ++i) {
      tasks::SampleRecord sample;
      sample.trial = i < 11 ? 4 : 5;
      sample.tick = i;
      sample.time = 0.1 * i;
      sample.fingers[0].p_WF = {0.01 * i, 0, 0};
      sample.fingers[1].p_WF = {1, 0, i < 11 ? 0.02 * i : 99.0};
      writer.pushSample(sample);
    }
    writer.close();
  }
  const auto hand = tasks::openHandDevices(replayOf(path));
  hand->setBase(0, Vec3::Zero(), Quat::Identity());
  hand->setBase(1, Vec3(1, 0, 0), Quat::Identity());
  hand->advanceTo(0.55);
  EXPECT_NEAR((hand->arm(0).sample().p_DF - Vec3(0.055, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((hand->arm(1).sample().p_DF - Vec3(0, 0, 0.11)).norm(), 0, 1e-12);
  hand->advanceTo(1.1);
  EXPECT_FALSE(hand->arm(0).sample().valid) << "the first trial has ended";
}

tasks::HandScene sceneOfArms() {
  const tasks::SpherePickupOptions options;
  return tasks::makePickupScene(options, tasks::makePickupObject(options), tasks::PickupTrialSpec{});
}

TEST(ArmBases, AreMovedAndTurnedByTheirCalibrationAndTheFingersStay) {
  tasks::HandScene scene = sceneOfArms();
  const tasks::HandScene nominal = sceneOfArms();
  tasks::DeviceCalibration file{"A1", {{"base_x", -0.01}, {"base_z", 0.02}, {"base_turn", 0.2}, {"gain", 3}}};
  tasks::standArms(scene, {tasks::armBaseIn(file), tasks::ArmBase{}});
  const Pose &now = scene.model.mounts[0].X_WD, &before = nominal.model.mounts[0].X_WD;
  EXPECT_NEAR((now.p - before.p - Vec3(-0.01, 0, 0.02)).norm(), 0, 1e-12);
  EXPECT_NEAR(now.q.angularDistance(before.q), 0.2, 1e-12);
  EXPECT_NEAR((now.q * scene.q_DF[0]).angularDistance(before.q * nominal.q_DF[0]), 0, 1e-7)
      << "the finger itself hasn't turned";
  EXPECT_EQ(scene.model.mounts[1].X_WD.p, nominal.model.mounts[1].X_WD.p);
}

TEST(ArmBases, ThatDoNotFaceEachOtherAreRefusedByName) {
  tasks::HandScene turned = sceneOfArms();
  const std::string why = errorOf([&] {
    tasks::standArms(turned, {tasks::ArmBase{}, tasks::ArmBase{Vec3::Zero(), 0.6}});
  });
  EXPECT_TRUE(contains(why, "thumb") && contains(why, "base_turn = 0.6")) << why;
  tasks::HandScene behind = sceneOfArms();
  EXPECT_THROW(tasks::standArms(behind, {tasks::ArmBase{Vec3(1, 0, 0), 0}, tasks::ArmBase{}}), InputError)
      << "behind the other one";
}

// It named the last column as missing.
TEST(ReplayHand, ReadsATableWhoseLinesEndAsOnOtherSystems) {
  const TemporaryDirectory folder;
  const std::string path = folder / "samples.csv";
  writeText(path,
            "time_s,f0_p_DF_x_m,f0_p_DF_y_m,f0_p_DF_z_m,f1_p_DF_x_m,f1_p_DF_y_m,f1_p_DF_z_m\r\n"
            "0,0,0,0,1,0,0\r\n1,0.1,0,0,1,0,0.2\r\n");
  const auto hand = tasks::openHandDevices(replayOf(path));
  hand->advanceTo(1);
  EXPECT_EQ(hand->arm(1).sample().p_DF, Vec3(1, 0, 0.2));
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
  const std::string header = "trial,time_s,f0_p_DF_x_m,f0_p_DF_y_m,f0_p_DF_z_m,f1_p_DF_x_m,f1_p_DF_y_m,f1_p_DF_z_m\n";
  writeText(path, header + "1,0,0,0,0,0,0\n");
  EXPECT_TRUE(contains(errorOf([&] { tasks::openHandDevices(replayOf(path)); }), ":2: \"\" in column 8"))
      << "a row that is cut off";
  writeText(path, header);
  EXPECT_TRUE(contains(errorOf([&] { tasks::openHandDevices(replayOf(path)); }), "no places"));
  EXPECT_THROW(tasks::openHandDevices(replayOf("")), DeviceError);
}

}  // namespace
}  // namespace pincer::tests
