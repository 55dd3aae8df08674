// Bodies that a scene draws into each other are named with their depth; what only moves towards each other isn't.
#include "pincer/tasks/run/scene/start_overlaps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pincer/tasks/run/scene.h"

namespace pincer::tasks {
namespace {

std::vector<StartOverlap> overlapsOf(const std::string& text) {
  const Scene scene = parseScene(text, "drawn.json");
  const grasp::GraspModel model = buildWorld(scene);
  return overlapsAtStart(model.world, startState(scene, model).world);
}

// A cube of 40 mm on a table whose top is at 0, drawn `depth` into it, with a speed.
std::string cubeOnTable(double depth, double speed) {
  return fmt::format(R"({{"version": 1, "duration": 0.1, "bodies": [
    {{"name": "table", "shape": {{"type": "box", "size": [1, 1, 0.1]}}, "position": [0, 0, -0.05], "static": true}},
    {{"name": "cube", "shape": {{"type": "box", "size": [0.04, 0.04, 0.04]}}, "mass": 0.1,
      "position": [0, 0, {}], "velocity": [0, 0, {}], "angular_velocity": [3, 0, 0]}}]}})",
                     0.02 - depth, -speed);
}

TEST(StartOverlaps, AreThoseThatTheSceneDraws) {
  for (const double depth : {2e-5, 1e-3, 7e-3}) {
    for (const double speed : {0.0, 2.0}) {
      const std::vector<StartOverlap> overlaps = overlapsOf(cubeOnTable(depth, speed));
      ASSERT_EQ(overlaps.size(), 1u) << depth << ", " << speed;
      EXPECT_EQ(overlaps[0].a, 0);
      EXPECT_EQ(overlaps[0].b, 1);
      EXPECT_NEAR(overlaps[0].depth, depth, 1e-12) << speed;  // of a turn, a speed and a fall nothing is left
    }
  }
}

TEST(StartOverlaps, AreNoneWhereThingsOnlyTouchOrLand) {
  for (const double depth : {9e-6, 0.0, -5e-4}) {
    for (const double speed : {0.0, 2.0}) EXPECT_TRUE(overlapsOf(cubeOnTable(depth, speed)).empty()) << depth;
  }
}

// A jaw that its joint moves into the cube, and a driven plate that passes through it.
TEST(StartOverlaps, AreFoundAtJointsAndDrivenBodiesWhereTheyStart) {
  const std::string rest = R"(
    {"name": "cube", "shape": {"type": "box", "size": [0.04, 0.04, 0.04]}, "mass": 0.1, "position": [0, 0, 0]},
    {"name": "jaw", "shape": {"type": "box", "size": [0.02, 0.02, 0.02]}, "mass": 0.1, "position": [0.026, 0, 0], "velocity": [-1, 0, 0]},
    {"name": "plate", "shape": {"type": "box", "size": [0.1, 0.1, 0.01]}, "trajectory": {"keyframes": [
      {"time": 0, "position": [0, 0, -0.022]}, {"time": 0.01, "position": [0, 0, 0.1]}]}}],
    "joints": [{"name": "slide", "type": "slider", "body": "jaw", "axis": [1, 0, 0]}],
    "fingers": [{"name": "tip", "position": [0, 0, 0.01]}]})";
  const std::vector<StartOverlap> overlaps = overlapsOf(R"({"version": 1, "duration": 0.1, "bodies": [)" + rest);
  ASSERT_EQ(overlaps.size(), 2u);
  EXPECT_NEAR(overlaps[0].depth, 0.004, 1e-12);
  EXPECT_EQ(overlaps[0].b, 1);
  EXPECT_NEAR(overlaps[1].depth, 0.003, 1e-12);
  EXPECT_EQ(overlaps[1].b, 2);
}

}  // namespace
}  // namespace pincer::tasks
