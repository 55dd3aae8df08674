// Robots in the style of public models, tests/robots/models: each is read with nothing refused, and whatever its drives
// are told, all stays finite and ticks are solved.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/random_numbers.h"

namespace pincer::tasks {
namespace {

constexpr double kEvery = 0.2;  // [s]: when targets change

// Each drive is told something new of its range five times a second until `last` [s], or up to one unit where it has
// none.
void tellAtRandom(double last, unsigned seed, Scene& scene) {
  tests::RandomNumbers random(seed);
  for (SceneDrive& drive : scene.drives) {
    if (drive.model.gain == 0) continue;  // a spring
    const double lower = std::max(drive.model.lower_control, -1e3), upper = std::min(drive.model.upper_control, 1e3);
    const bool has_range = lower > -1e3 && upper < 1e3;
    std::vector<TimedPoint> told;
    for (double time = 0; time < last + 0.5 * kEvery; time += kEvery) {
      const double value = random.uniform(has_range ? lower : -1, has_range ? upper : 1);
      told.push_back({time, {value, 0, 0}, Vec3::Zero()});
    }
    drive.control = Trajectory::throughKeyframes(std::move(told));
    drive.moves = true;
  }
}

Simulation toldAtRandom(const char* model, double last, unsigned seed) {
  const std::string path = std::string(PINCER_SOURCE_DIR "/tests/robots/models/") + model + ".xml";
  RobotImport import = readMjcf(path);
  Scene scene = parseScene(sceneOfRobot(import.robot, {}, import.notes), path + ".json");
  tellAtRandom(last, seed, scene);
  return Simulation(std::move(scene));
}

class RobotModels : public ::testing::TestWithParam<const char*> {};

// Stops, brakes and feet of long arms and free bases, whose movers are several blocks, once left up to a hundred ticks
// of ten seconds unsolved.
TEST_P(RobotModels, StaySolvedAndFiniteWhateverTheirDrivesAreTold) {
  constexpr double kSeconds = 10;
  Simulation sim = toldAtRandom(GetParam(), kSeconds, 1);
  while (sim.time() < kSeconds) {
    // more hits on stops in one tick than it is cut for do land (docs/engine.md)
    ASSERT_EQ(sim.tick().status & ~engine::kImpactsCut, 0u) << "at " << sim.time() << " s";
    for (const engine::BodyState& body : sim.state().world.bodies)
      ASSERT_TRUE(body.X_WI.p.allFinite() && body.v_W.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Menagerie, RobotModels,
                         ::testing::Values("actuators", "arm_gripper", "ball_free", "compiler", "contacts", "delta",
                                           "equalities", "floating_base", "humanoid", "includes", "meshes",
                                           "mobile_base", "sprung"));

// Four feet hold a trunk that drives let sway: warm starts were exact in one tick and off by 1e-14 m/s in the next two,
// and each exact one began the count anew for which they have to be.
TEST(RestingRobots, OnFourFeetStandStillToTheBit) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    constexpr double kToldFor = 2, kRestsAt = 4;  // [s]; at rest from 3.3 s on
    Simulation sim = toldAtRandom("floating_base", kToldFor, seed);
    while (sim.time() < kRestsAt) sim.tick();
    const std::vector<double> q = sim.state().world.tree_q;
    for (int n = 0; n < 100; ++n) EXPECT_TRUE(sim.tick().asleep) << seed;
    EXPECT_EQ(sim.state().world.tree_q, q);
  }
}

}  // namespace
}  // namespace pincer::tasks
