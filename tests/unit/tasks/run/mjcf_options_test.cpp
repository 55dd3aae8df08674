// MJCF as public models have it: settings and attributes that many of them share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

class MjcfOptions : public ::testing::Test {
 protected:
  RobotImport read(const std::string& inside) {
    const std::string path = folder_ / "robot.xml";
    std::ofstream(path) << "<mujoco>\n" + inside + "\n</mujoco>";
    return readMjcf(path);
  }
  Robot robot(const std::string& inside) { return read(inside).robot; }
  std::string complaint(const std::string& inside) {
    return tests::errorOf([&] { read(inside); });
  }

  static constexpr double kRoundOff = 1e-14;  // of numbers of order 1, through a few products
  tests::TemporaryDirectory folder_;
};

// A robot with something of all that a flag can switch off.
const std::string kAll = R"(<worldbody><geom type="plane" size="1 1 1"/><body name="a"><joint name="j" range="-1 1"
    stiffness="1" damping="1" frictionloss="1"/><geom size=".1"/><body name="b"><joint name="k"/><geom size=".1"/></body></body></worldbody>
  <equality><joint joint1="j" joint2="k"/></equality><actuator><position joint="k" ctrlrange="-1 1"/></actuator>
  <keyframe><key ctrl="1"/></keyframe>)";

TEST_F(MjcfOptions, AFlagSwitchesOffItsKindOfForceAndNoOther) {
  const std::vector<std::pair<std::string, std::function<bool(const Robot&)>>> kinds = {
      {"limit", [](const Robot& r) { return !r.bodies[0].joints[0].limits; }},
      {"spring", [](const Robot& r) { return r.bodies[0].joints[0].stiffness == 0; }},
      {"damper", [](const Robot& r) { return r.bodies[0].joints[0].damping == 0; }},
      {"frictionloss", [](const Robot& r) { return r.bodies[0].joints[0].friction == 0; }},
      {"equality", [](const Robot& r) { return r.couplings.empty(); }},
      {"contact", [](const Robot& r) { return r.bodies[0].geoms[0].isOnlySeen() && r.world_geoms[0].isOnlySeen(); }},
      {"actuation", [](const Robot& r) { return r.drives.empty() && r.keyframes[0].controls.empty(); }},
      {"clampctrl", [](const Robot& r) { return r.drives.empty() || !r.drives[0].controls; }},
      {"gravity", [](const Robot& r) { return r.gravity_W.isZero(); }},
  };
  for (const auto& [flag, unused] : kinds) {
    const Robot r = robot("<option><flag " + flag + "=\"disable\"/></option>" + kAll);
    for (const auto& [kind, is_off] : kinds) {
      const bool along_with = flag == "actuation" && kind == "clampctrl";  // no drive, no range
      EXPECT_EQ(is_off(r), kind == flag || along_with) << flag << " " << kind;
    }
  }
  const Robot unconstrained = robot("<option><flag constraint=\"disable\"/></option>" + kAll);
  for (const char* kind : {"limit", "frictionloss", "equality", "contact"}) {
    const auto at = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == kind; });
    EXPECT_TRUE(at->second(unconstrained)) << kind;
  }
  EXPECT_FALSE(unconstrained.drives.empty());
}

// Gymnasium's older models say so.
TEST_F(MjcfOptions, LocalCoordinatesAreWhatThereIs) {
  const std::string ball = "<worldbody><body><freejoint/><geom size=\".1\"/></body></worldbody>";
  EXPECT_EQ(robot("<compiler coordinate=\"local\"/>" + ball).bodies.size(), 1u);
  EXPECT_NE(complaint("<compiler coordinate=\"global\"/>" + ball).find("isn't known since MuJoCo 2.3.4"),
            std::string::npos);
}

TEST_F(MjcfOptions, FramesOfFreeBodiesStayAsTheyAreDrawn) {
  const auto ball = [](const std::string& align) {
    return "<worldbody><body><freejoint align=\"" + align + "\"/><geom size=\".1\"/></body></worldbody>";
  };
  EXPECT_EQ(robot("<compiler alignfree=\"false\"/>" + ball("auto")).bodies.size(), 1u);
  EXPECT_EQ(robot(ball("false")).bodies.size(), 1u);
  EXPECT_NE(complaint(ball("true")).find("stay as they are drawn"), std::string::npos);
  EXPECT_NE(complaint("<compiler alignfree=\"true\"/>").find("stay as they are drawn"), std::string::npos);
}

TEST_F(MjcfOptions, ASiteMayBeGivenByItsEnds) {
  const Robot r = robot(R"(<default><site type="capsule" size=".01"/></default><worldbody><body><freejoint/>
    <geom size=".1"/><site name="s" fromto="0 0 0 0 2 0"/></body></worldbody>)");
  EXPECT_EQ(r.frames.at(0).X_BF.p, Vec3(0, 1, 0));
  EXPECT_LT((r.frames.at(0).X_BF.q * Vec3::UnitZ() + Vec3::UnitY()).norm(), kRoundOff);
}

// A rod of 2 kg and 1 m turns about its end: m = 2/3 kg m^2, and 1/3 more of the armature. T = .5 s, z = 2.
TEST_F(MjcfOptions, ASpringMayBeGivenByItsTime) {
  const Robot r = robot(R"(<worldbody><body><joint axis="0 1 0" armature=".3333333333333333" springdamper=".5 2"/>
    <inertial mass="2" pos="0 0 .5" diaginertia=".16666666666666666 .16666666666666666 1e-3"/></body></worldbody>)");
  EXPECT_NEAR(r.bodies.at(0).joints.at(0).stiffness, 1, kRoundOff);
  EXPECT_NEAR(r.bodies.at(0).joints.at(0).damping, 4, kRoundOff);
  // While the other joint is free, each feels less: M = [7.3533 .0377; .0377 .0533], 1/(M^-1)_jj.
  const Robot two = robot(R"(<worldbody><body><joint axis="0 1 0" springdamper=".5 2" armature=".1"/>
    <geom type="box" size=".1 .2 .3" pos=".3 0 0"/><body pos=".4 0 0"><joint axis="0 1 1" springdamper=".2 .5"/>
    <geom type="box" size=".1 .1 .1"/></body></body></worldbody>)");
  const double m00 = 7.25 + 1.0 / 300 + .1, m11 = .16 / 3, m01 = m11 / std::sqrt(2);
  EXPECT_NEAR(two.bodies[0].joints[0].stiffness, m00 - m01 * m01 / m11, 1e-12);
  EXPECT_NEAR(two.bodies[1].joints[0].stiffness, (m11 - m01 * m01 / m00) / .01, 1e-12);
  EXPECT_NE(
      complaint("<worldbody><body><joint type=\"ball\" springdamper=\"1 1\"/><geom size=\".1\"/></body></worldbody>")
          .find("goes with hinges and slides here."),
      std::string::npos);
}

TEST_F(MjcfOptions, NamesThatAreMadeUpAreNotThoseOfTheFile) {
  const Robot r = robot(R"(<worldbody><body><joint/><geom size=".1"/><body name="body0"><joint name="body0__joint"/>
    <geom size=".1"/></body></body></worldbody>)");
  EXPECT_EQ(r.bodies.at(0).name, "body0_");
  EXPECT_EQ(r.bodies.at(0).joints.at(0).name, "body0__joint_");
}

// There the two have the larger friction of both, here the ball has none.
TEST_F(MjcfOptions, FrictionBesideCondim1IsNotedWhereItWouldCount) {
  const auto notes = [&](const std::string& floor) {
    return read("<worldbody><geom type=\"plane\" size=\"1 1 1\" friction=\"" + floor +
                "\"/><body><freejoint/><geom size=\".1\" condim=\"1\" friction=\".8\"/></body></worldbody>")
        .notes.all();
  };
  ASSERT_EQ(notes("0.5").size(), 1u);
  EXPECT_EQ(notes("0.5")[0].what, "geom friction beside condim 1");
  EXPECT_TRUE(notes("0.8").empty());
}

TEST_F(MjcfOptions, ARangeOfControlsIsGivenOnce) {
  const std::string arm =
      R"(<default><position inheritrange="1"/><default class="x"><position ctrlrange="-1 1"/></default></default>
    <worldbody><body><joint name="j" range="-30 30"/><geom size=".1"/></body></worldbody>)";
  EXPECT_NE(complaint(arm + "<actuator><position class=\"x\" joint=\"j\"/></actuator>").find("beside an inheritrange"),
            std::string::npos);
  EXPECT_TRUE(robot(arm + "<actuator><position joint=\"j\"/></actuator>").drives.at(0).controls);
  EXPECT_TRUE(
      robot(arm + "<actuator><position class=\"x\" joint=\"j\" inheritrange=\"0\"/></actuator>").drives.at(0).controls);
}

}  // namespace
}  // namespace pincer::tasks
