// Copies that <replicate> asks for: names, places and what is refused.
#include "pincer/tasks/run/robot/mjcf_replicate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

class MjcfReplicate : public ::testing::Test {
 protected:
  Robot robot(const std::string& inside) {
    const std::string path = folder_ / "robot.xml";
    std::ofstream(path) << "<mujoco>\n" + inside + "\n</mujoco>";
    return readMjcf(path).robot;
  }
  std::string complaint(const std::string& inside) {
    return tests::errorOf([&] { robot(inside); });
  }

  static constexpr double kRoundOff = 1e-14;  // of numbers of order 1, through a few products
  tests::TemporaryDirectory folder_;
};

TEST_F(MjcfReplicate, EachCopyIsTurnedFromTheOneBefore) {
  const Robot r = robot(R"(<worldbody><body name="hub"><geom size=".1"/><replicate count="3" euler="0 0 120" sep="-">
    <body name="leg" pos="2 0 0"><joint name="hip" axis="0 1 0"/><geom name="foot" size=".1"/></body></replicate></body></worldbody>
    <actuator><motor joint="hip-2"/></actuator>)");
  ASSERT_EQ(r.bodies.size(), 4u);
  const std::vector<Pose> poses = bodyPoses(r, drawnCoordinates(r));
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi / 3 * i;
    const auto index = static_cast<std::size_t>(i + 1);
    EXPECT_EQ(r.bodies[index].name, "leg-" + std::to_string(i));
    EXPECT_LT((poses[index].p - 2 * Vec3(std::cos(angle), std::sin(angle), 0)).norm(), kRoundOff);
  }
  EXPECT_EQ(r.drives.at(0).joint, "hip-2");
}

// Offsets are along the axes of the copy before: here a hexagon's corners.
TEST_F(MjcfReplicate, OffsetsAreInTheFrameOfTheCopyBefore) {
  const Robot r = robot(R"(<worldbody><replicate count="7" offset="1 0 0" euler="0 0 60">
    <body name="b"><freejoint/><geom size=".1"/></body></replicate></worldbody>)");
  ASSERT_EQ(r.bodies.size(), 7u);
  EXPECT_LT((r.bodies[2].X_PB.p - Vec3(1.5, std::sqrt(0.75), 0)).norm(), kRoundOff);
  EXPECT_LT(r.bodies[6].X_PB.p.norm(), kRoundOff);
}

TEST_F(MjcfReplicate, NumbersOfManyCopiesHaveOneLengthAndInnerOnesComeFirst) {
  const Robot r = robot(R"(<worldbody><replicate count="2" offset="0 9 0"><replicate count="10" offset="1 0 0">
    <body name="b"><freejoint/><geom size=".1"/></body></replicate></replicate></worldbody>)");
  ASSERT_EQ(r.bodies.size(), 20u);
  EXPECT_EQ(r.bodies.front().name, "b000");
  EXPECT_EQ(r.bodies.back().name, "b091");
  EXPECT_LT((r.bodies.back().X_PB.p - Vec3(9, 9, 0)).norm(), kRoundOff);
}

TEST_F(MjcfReplicate, CopiesHaveTheClassOfTheirReplicate) {
  const Robot r = robot(R"(<default><default class="soft"><joint stiffness="3"/></default></default>
    <worldbody><replicate count="2" childclass="soft"><body><joint/><geom size=".1"/></body></replicate></worldbody>)");
  for (const RobotBody& body : r.bodies) EXPECT_EQ(body.joints.at(0).stiffness, 3);
}

TEST_F(MjcfReplicate, WhatCantBeCopiedIsRefused) {
  const std::string body = "<body><freejoint/><geom size=\".1\"/></body>";
  const auto replicate = [&](const std::string& attributes, const std::string& inside) {
    return "<worldbody><replicate " + attributes + ">" + inside + "</replicate></worldbody>";
  };
  EXPECT_NE(complaint(replicate("", body)).find("needs a count of 1 or more."), std::string::npos);
  EXPECT_NE(complaint(replicate("count=\"-1\"", body)).find("needs a count of 1 or more."), std::string::npos);
  EXPECT_NE(complaint(replicate("count=\"100001\"", body)).find("too many copies"), std::string::npos);
  const std::string nested = "<replicate count=\"1000\">" + body + "</replicate>";
  EXPECT_NE(complaint(replicate("count=\"1000\"", nested)).find("too many copies"), std::string::npos);
  EXPECT_NE(complaint(replicate("count=\"2\" euler=\"0 0\"", body)).find("where 3 are wanted"), std::string::npos);
}

}  // namespace
}  // namespace pincer::tasks
