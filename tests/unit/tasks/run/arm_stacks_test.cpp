// An arm of six joints with a gripper, from a URDF file: it stacks ten boxes, and is the same arm in MJCF.
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "pincer/tasks/run/scene/scene_robot.h"
#include "pincer/tasks/run/scene/sim_run.h"

namespace pincer::tasks {
namespace {

const std::string kFolder = PINCER_SOURCE_DIR "/tasks/scenes/files/";

TEST(ArmStacks, TenBoxesStandWhereTheyShouldAndNoTickIsFlagged) {
  Simulation sim(readScene(kFolder + "arm_stacks.json"));
  const std::atomic<bool> never = false;
  const SimResult result = runScene(sim, {}, never, [](std::int64_t) {});
  const std::vector<Expectation>& expected = result.log.expectations();
  ASSERT_EQ(expected.size(), 51u);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(result.log.outcomes()[i].holds())
        << expected[i].quantity.name << ": " << result.log.outcomes()[i].measured << ", not " << expected[i].value;
  }
  for (std::size_t kind = 0; kind < kStatusKinds.size(); ++kind)
    EXPECT_EQ(result.statuses.of(kind), 0) << kStatusKinds[kind].key;
}

TEST(ArmStacks, TheArmIsOneSceneFromUrdfAndMjcf) {
  std::string urdf_remarks, mjcf_remarks;
  EXPECT_EQ(robotSceneText(kFolder + "arm.urdf", urdf_remarks), robotSceneText(kFolder + "arm.xml", mjcf_remarks));
  EXPECT_NE(urdf_remarks.find("limit effort"), std::string::npos);
  EXPECT_EQ(mjcf_remarks, "");
}

}  // namespace
}  // namespace pincer::tasks
