// Robots in the style of public models, tests/robots/models: each is read with nothing refused, and whatever its drives
// are told, all stays finite and ticks are solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::tasks {
namespace {

constexpr int kModelTicks = 1000;
constexpr double kEvery = 0.2, kLast = 10;  // [s]: when targets change

// Each drive is told something new of its range five times a second, or up to one unit where it has none.
void tellAtRandom(Scene& scene) {
  tests::RandomNumbers random(1);
  for (SceneDrive& drive : scene.drives) {
    if (drive.model.gain == 0) continue;  // a spring
    const double lower = std::max(drive.model.lower_control, -1e3), upper = std::min(drive.model.upper_control, 1e3);
    const bool has_range = lower > -1e3 && upper < 1e3;
    std::vector<TimedPoint> told;
    for (double time = 0; time <= kLast; time += kEvery) {
      const double value = random.uniform(has_range ? lower : -1, has_range ? upper : 1);
      told.push_back({time, {value, 0, 0}, Vec3::Zero()});
    }
    drive.control = Trajectory::throughKeyframes(std::move(told));
    drive.moves = true;
  }
}

class RobotModels : public ::testing::TestWithParam<const char*> {};

TEST_P(RobotModels, StaySolvedAndFiniteWhateverTheirDrivesAreTold) {
  const std::string path = std::string(PINCER_SOURCE_DIR "/tests/robots/models/") + GetParam() + ".xml";
  RobotImport import = readMjcf(path);
  Scene scene = parseScene(sceneOfRobot(import.robot, {}, import.notes), path + ".json");
  tellAtRandom(scene);
  Simulation sim(std::move(scene));
  int unsolved = 0;
  for (int n = 0; n < kModelTicks; ++n) {
    const std::uint32_t status = sim.tick().status;
    unsolved += (status & engine::kSolverNotConverged) != 0;
    ASSERT_EQ(status & ~engine::kSolverNotConverged, 0u) << "tick " << n;
    for (const engine::BodyState& body : sim.state().world.bodies)
      ASSERT_TRUE(body.X_WI.p.allFinite() && body.v_W.allFinite());
  }
  // Parts that stops and drives press against each other may contradict each other (docs/robots.md).
  EXPECT_LE(unsolved, kModelTicks / 100);
}

INSTANTIATE_TEST_SUITE_P(Menagerie, RobotModels,
                         ::testing::Values("actuators", "arm_gripper", "ball_free", "compiler", "contacts", "delta",
                                           "equalities", "floating_base", "humanoid", "includes", "meshes",
                                           "mobile_base", "sprung"));

}  // namespace
}  // namespace pincer::tasks
