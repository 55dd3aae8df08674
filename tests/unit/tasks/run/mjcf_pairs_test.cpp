// Pairs of geoms with a contact of their own: what they become, and where they can't be had.
#include <gtest/gtest.h>

#include <fstream>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/sim_run.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

class MjcfPairs : public ::testing::Test {
 protected:
  // A box on a plane; `box` and `plane` add attributes to their geoms.
  static std::string boxOnPlane(const std::string& box, const std::string& plane, const std::string& rest) {
    return "<mujoco>\n<option gravity=\"3 0 -9.81\"/><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 .1\" " +
           plane + "/>\n<body name=\"thing\" pos=\"0 0 .1\"><freejoint/><geom name=\"box\" type=\"box\" " +
           "size=\".1 .1 .1\" " + box + "/>\n<geom name=\"top\" type=\"sphere\" pos=\"0 0 .1\" size=\".01\" " + kSeen +
           "/></body></worldbody>\n" + rest + "</mujoco>";
  }
  RobotImport import(const std::string& xml) {
    std::ofstream(folder_ / "robot.xml") << xml;
    return readMjcf(folder_ / "robot.xml");
  }
  Scene scene(const std::string& xml) {
    RobotImport read = import(xml);
    Scene made = parseScene(sceneOfRobot(read.robot, {}, read.notes), folder_ / "robot.json");
    notes_ = read.notes;
    return made;
  }
  // How far the thing slides in half a second [m].
  double slide(const std::string& xml) {
    Simulation sim(scene(xml));
    for (int n = 0; n < 250; ++n) EXPECT_EQ(sim.tick().status, engine::kStepOk);
    return quantityOf("thing.p_x", sim.scene()).measure(sim.moment());
  }
  std::string complaint(const std::string& xml) {
    return tests::errorOf([&] { scene(xml); });
  }

  static constexpr const char* kSeen = "contype=\"0\" conaffinity=\"0\"";
  tests::TemporaryDirectory folder_;
  ImportNotes notes_;
};

// g tan = 3 m/s^2: a friction of 0.2 leaves 3 - 0.2 g of it, one of 1 holds.
TEST_F(MjcfPairs, ThePairsFrictionIsThatOfTheTwoBodies) {
  const std::string pair = R"(<contact><pair geom1="box" geom2="floor" condim="3" friction="0.2"/></contact>)";
  EXPECT_NEAR(slide(boxOnPlane("", "", pair)), 0.5 * (3 - 0.2 * 9.81) * 0.25, 1e-3);
  EXPECT_NEAR(slide(boxOnPlane("", "", "")), 0, 1e-15);  // round-off of a tick
  const std::string slippery = R"(<contact><pair geom1="floor" geom2="box" condim="1" friction="1"/></contact>)";
  EXPECT_NEAR(slide(boxOnPlane("", "", slippery)), 0.5 * 3 * 0.25, 1e-3);
}

TEST_F(MjcfPairs, APairTouchesWhateverItsBitsSay) {
  const std::string pair = R"(<contact><pair geom1="box" geom2="floor"/></contact>)";
  EXPECT_NEAR(slide(boxOnPlane(kSeen, kSeen, pair)), 0, 1e-15);
  EXPECT_GT(slide(boxOnPlane(kSeen, kSeen, "")), 0.1);  // it falls, and is driven aside
}

TEST_F(MjcfPairs, ItsBitIsThatOfNoOtherGeom) {
  const Robot robot = import(boxOnPlane(kSeen, "contype=\"5\" conaffinity=\"2\"",
                                        R"(<contact><pair geom1="top" geom2="box"/></contact>)"))
                          .robot;
  const std::vector<RobotGeom>& geoms = robot.bodies.at(0).geoms;
  EXPECT_TRUE(canTouch(geoms.at(0), geoms.at(1)));
  EXPECT_FALSE(canTouch(geoms.at(0), robot.world_geoms.at(0)));
  EXPECT_FALSE(canTouch(geoms.at(1), robot.world_geoms.at(0)));
}

TEST_F(MjcfPairs, ThoseThatNeverTouchAreInTheReport) {
  scene(boxOnPlane("", "",
                   R"(<contact><pair geom1="box" geom2="floor"/><exclude body1="thing" body2="world"/></contact>)"));
  ASSERT_EQ(notes_.all().size(), 1u);
  EXPECT_EQ(notes_.all()[0].what, "pair of links that never touch");
}

TEST_F(MjcfPairs, WhatCantBeHadIsRefusedByFileAndLine) {
  const auto with = [&](const std::string& pair) { return boxOnPlane("", "", "<contact>" + pair + "</contact>"); };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {with(R"(<pair geom1="bix" geom2="floor"/>)"), "is the name of no geom. Did you mean \"box\"?"},
      {with(R"(<pair geom1="box" geom2="floor" friction="1"/>)"), "needs both condim and friction, or neither"},
      {with(R"(<pair geom1="box" geom2="floor" condim="3" friction="1 .5"/>)"), "isn't the same along both axes"},
      {with(R"(<pair geom1="box" geom2="floor" condim="2" friction="1"/>)"), "is none of 1, 3, 4, 6."},
      {with(R"(<pair geom1="box" geom2="floor" condim="3" friction="-1"/>)"), "has a negative coefficient."},
      {boxOnPlane("/><geom type=\"sphere\" size=\".2\"", "",
                  R"(<contact><pair geom1="box" geom2="floor" condim="3" friction=".1"/></contact>)"),
       "isn't all that touches"},
      {with(R"(<pair geom1="box" geom2="floor" condim="3" friction=".1"/>
               <pair geom1="top" geom2="floor" condim="3" friction=".2"/>)"),
       "has another friction than another pair of them"},
  };
  for (const auto& [xml, wanted] : cases) {
    const std::string message = complaint(xml);
    EXPECT_NE(message.find("robot.xml:"), std::string::npos) << message;
    EXPECT_NE(message.find(wanted), std::string::npos) << wanted << ": " << message;
  }
}

}  // namespace
}  // namespace pincer::tasks
