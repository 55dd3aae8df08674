// The program with Haply's service, emulated in this process: list, test, calibrate, and
// a whole session that replays to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>

#include "pincer/contact/error.h"
#include "pincer/devices/emulate/haply_server.h"
#include "pincer/tasks/lab/experiments/haply_wearer.h"
#include "pincer/tasks/lab/experiments/pickup_object.h"
#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/run/servo/arm_check.h"
#include "pincer/tasks/run/servo/haply_calibration.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/run_app.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tests {
namespace {

using devices::emulate::HaplyServer;
using devices::emulate::HaplyService;

TEST(HaplyCommands, ListTheServicesDevicesAndSayWhenNobodyAnswers) {
  std::string place;
  {
    HaplyServer server;
    place = server.place();
    const AppResult list = runPincer({"devices", "list", "--devices", "haply", "--service", place});
    EXPECT_EQ(list.exit_code, 0) << list.error;
    EXPECT_TRUE(contains(list.out, "049D") && contains(list.out, "04BA") && contains(list.out, "3.5")) << list.out;
    const AppResult json = runPincer({"devices", "list", "--json", "--timeout", "0.1", "--service", place});
    EXPECT_TRUE(contains(json.out, R"("kind":"haply","serial":"049D")") || contains(json.out, "04BA")) << json.out;
  }
  const AppResult none = runPincer({"devices", "list", "--devices", "haply", "--service", place});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_TRUE(contains(none.out, "systemctl start")) << none.out;
  EXPECT_EQ(runPincer({"devices", "list", "--devices", "haply", "--service", "192.168.0.1:10001"}).exit_code, 2);
}

TEST(HaplyCommands, TestDrivesAnArmByItselfAndGivesAVerdict) {
  HaplyServer server;
  const AppResult test = runPincer({"devices", "test", "049D", "--devices", "haply", "--force", "0.3", "--yes",
                                    "--watchdog", "100", "--service", server.place()});
  const bool fit = contains(test.out, "Verdict: fit for a session");  // on a busy machine it says why not
  EXPECT_EQ(test.exit_code, fit ? 0 : 4) << test.out << test.error;
  EXPECT_TRUE(fit || contains(test.out, "Verdict: not fit")) << test.out;
  EXPECT_TRUE(contains(test.out, "age of a sample")) << test.out;
  EXPECT_EQ(server.force(0), 0);
  const AppResult other =
      runPincer({"devices", "test", "04XX", "--devices", "haply", "--yes", "--service", server.place()});
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_TRUE(contains(other.error, "04XX")) << other.error;
}

TEST(HaplyCommands, TestFindsAnArmThatDoesNotMove) {
  HaplyServer server;
  server.setFault(devices::emulate::HaplyFault::kPlaceFrozen);
  const AppResult test = runPincer({"devices", "test", "049D", "--devices", "haply", "--force", "0.3", "--yes",
                                    "--watchdog", "100", "--service", server.place()});
  EXPECT_EQ(test.exit_code, 4);
  EXPECT_TRUE(contains(test.out, "not fit")) << test.out;
}

TEST(HaplyCommands, CalibrateWritesWhereAnArmStandsToAFile) {
  const TemporaryDirectory folder;
  HaplyServer server;
  const std::string file = folder / "A.json";
  const AppResult here =
      runPincer({"devices", "calibrate", "049D", "--devices", "haply", "--here", "--set", "mount_turn=0.1", "--align",
                 "index", "--grip", "1605", "--save", file, "--service", server.place()});
  ASSERT_EQ(here.exit_code, 0) << here.error;
  const tasks::DeviceCalibration calibration = tasks::readCalibration(file);
  EXPECT_EQ(calibration.serial, "049D");
  EXPECT_EQ(calibration.values.at("mount_turn"), 0.1);
  EXPECT_NEAR(calibration.values.at("centre_y"), -0.17, 2e-3);
  EXPECT_NEAR(tasks::haplyArmOf(calibration, "1605").frame.q_align.norm(), 1, 1e-9);
  EXPECT_EQ(runPincer({"devices", "calibrate", "049D", "--devices", "haply", "--set", "peak_force=9", "--set",
                       "idle_after=0.05"})
                .exit_code,
            3);
  EXPECT_EQ(runPincer({"devices", "calibrate", "049D", "--here"}).exit_code, 2);
}

TEST(HaplyCommands, CalibrateTakesOutTheDriftOfAGripAndRefusesAnotherTurn) {
  const TemporaryDirectory folder;
  HaplyServer server;
  const std::string file = folder / "A.json";
  const auto calibrate = [&](const char* option) {
    return runPincer({"devices", "calibrate", "049D", "--devices", "haply", option, "index", "--grip", "1605", "--load",
                      file, "--save", file, "--service", server.place()});
  };
  ASSERT_EQ(runPincer({"devices", "calibrate", "049D", "--devices", "haply", "--save", file}).exit_code, 0);
  EXPECT_TRUE(contains(calibrate("--undrift").error, "--align")) << "never aligned";
  ASSERT_EQ(calibrate("--align").exit_code, 0);
  const auto turnGrip = [&](const Vec3& about_D) {  // from how it was aligned
    server.with([&](HaplyService& service) { service.plant(0).arm().setGimbal(quatFromRotationVector(about_D)); });
  };
  turnGrip({0, 0.3, 0});  // D's y is up
  ASSERT_EQ(calibrate("--undrift").exit_code, 0);
  EXPECT_NEAR(tasks::readCalibration(file).values.at("grip_yaw"), 0.3, 1e-3);
  turnGrip({0.5, 0, 0});
  const AppResult tilted = calibrate("--undrift");
  EXPECT_EQ(tilted.exit_code, 4);
  EXPECT_TRUE(contains(tilted.error, "tilted by 29 degrees")) << tilted.error;
  EXPECT_NEAR(tasks::readCalibration(file).values.at("grip_yaw"), 0.3, 1e-3) << "kept";
}

// The emulated hands hold both knobs, 30 mm apart, at one place after another, all within reach; the
// thumb's arm stands 20 mm and 8 degrees off.
TEST(HaplyCommands, TouchFindsWhereTheSecondArmStands) {
  const TemporaryDirectory folder;
  const tasks::SpherePickupOptions options;
  const tasks::HandScene scene =
      tasks::makePickupScene(options, tasks::makePickupObject(options), tasks::PickupTrialSpec{});
  const Pose X_WA = scene.model.mounts[0].X_WD, nominal = scene.model.mounts[1].X_WD;
  const double turn = 8 * std::numbers::pi / 180;
  const Pose X_WB{quatFromRotationVector({0, 0, turn}) * nominal.q, nominal.p + Vec3(0.012, -0.016, 0.004)};
  const Vec3 middle_W = 0.5 * (X_WA.p + X_WB.p);
  double time = 0;
  HaplyServer server({}, 0, 0, [&](HaplyService& service) {
    const double k = std::floor((time += 1e-3) / 0.6);
    const Vec3 direction = Vec3(std::sin(2 * k), std::cos(3 * k), std::sin(5 * k + 1)).normalized();
    const Vec3 place_W = middle_W + 0.02 * Vec3(std::sin(1.1 * k), std::sin(1.7 * k + 1), std::sin(2.3 * k + 2));
    const auto hold = [&](std::size_t arm, const Pose& X_WD, const Vec3& p_W) {
      service.plant(arm).arm().setHand({.p_D = X_WD.inverse() * p_W, .stiffness = 4000, .damping = 40, .mass = 0.07});
    };
    hold(0, X_WA, place_W + 0.015 * direction);
    hold(1, X_WB, place_W - 0.015 * direction);
  });
  const AppResult touch = runPincer({"devices", "calibrate", "049D,04BA", "--devices", "haply", "--touch", "--save",
                                     folder / "B.json", "--service", server.place()});
  ASSERT_EQ(touch.exit_code, 0) << touch.out << touch.error;
  const tasks::ArmBase base = tasks::armBaseIn(tasks::readCalibration(folder / "B.json"));
  EXPECT_LT((base.offset_W - Vec3(0.012, -0.016, 0.004)).norm(), 0.5e-3) << touch.out;
  EXPECT_NEAR(base.turn, turn, 0.2 * std::numbers::pi / 180) << touch.out;
  EXPECT_EQ(runPincer({"devices", "calibrate", "049D", "--devices", "haply", "--touch"}).exit_code, 2);
  EXPECT_EQ(runPincer({"devices", "calibrate", "A,B", "--touch"}).exit_code, 2);
}

TEST(HaplyCalibration, AllowsMoreForceOnlyOnceTheArmsOwnDeadlineWasMeasured) {
  tasks::DeviceCalibration file = tasks::uncalibratedHaply("049D");
  EXPECT_EQ(tasks::haplyArmOf(file, "").peak_force, 2);
  file.values["peak_force"] = 8;
  EXPECT_EQ(tasks::haplyArmOf(file, "").peak_force, 2) << "nobody knows when it goes idle";
  file.values["idle_after"] = 0.5;
  EXPECT_EQ(tasks::haplyArmOf(file, "").peak_force, 2) << "too late";
  file.values["idle_after"] = 0.1;
  EXPECT_EQ(tasks::haplyArmOf(file, "").peak_force, 8);
  file.values.erase("peak_force");
  EXPECT_EQ(tasks::haplyArmOf(file, "").peak_force, 5);
  const std::string why = errorOf([&] { tasks::haplyArmOf(file, "1605"); });
  EXPECT_TRUE(contains(why, "align_w") && contains(why, "--align")) << why;
}

TEST(HaplyCommands, RefuseTwoArmsWhoseStanceNobodyKnows) {
  const AppResult run =
      runPincer({"run", "sphere-pickup", "--devices", "haply", "--arms", "049D,04BA", "--service", "127.0.0.1:1"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_TRUE(contains(run.error, "calibrat") && contains(run.error, "049D")) << run.error;
}

// Two arms, two grips, a hand that feels nothing but them; forces, gate and session by the wall clock. How punctual
// this machine is isn't asked: a trial may end in a fault, and is replayed like any other.
TEST(HaplyCommands, ASphereIsPickedUpAndTheSessionReplaysToTheBit) {
  const TemporaryDirectory folder;
  std::optional<tasks::HaplyWearer> wearer;
  HaplyServer server({}, 0, 0, [&](HaplyService& service) {
    if (!wearer) wearer.emplace(service);
    wearer->act(service);
  });
  for (const char* id : {"049D", "04BA"}) {
    ASSERT_EQ(runPincer({"devices", "calibrate", id, "--devices", "haply", "--set", "align_w=1", "--save", folder / id})
                  .exit_code,
              0);
  }
  const std::string out = folder / "session";
  const AppResult run = runPincer({"run",
                                   "sphere-pickup",
                                   "--devices",
                                   "haply",
                                   "--arms",
                                   "049D,04BA",
                                   "--grips",
                                   "1605,1606",
                                   "--calibration",
                                   (folder / "049D") + "," + (folder / "04BA"),
                                   "--service",
                                   server.place(),
                                   "--yes",
                                   "--watchdog",
                                   "100",
                                   "--condition",
                                   "force",
                                   "--repetitions",
                                   "1",
                                   "--friction",
                                   "0.9",
                                   "--out",
                                   out});
  EXPECT_TRUE(contains(run.out, "Session: ")) << run.exit_code << run.out << run.error;
  const AppResult replay = runPincer({"replay", out + "/session.db"});
  EXPECT_EQ(replay.exit_code, 0) << replay.out << replay.error;
  EXPECT_TRUE(contains(replay.out, "The same to the bit: 1 trial")) << replay.out;
  EXPECT_EQ(server.force(0), 0);
}

}  // namespace
}  // namespace pincer::tests
