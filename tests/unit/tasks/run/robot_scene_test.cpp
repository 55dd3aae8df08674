// Robots as scenes: loops, ranges, springs of tendons, and that all ways to run one give the same bits.
#include "pincer/tasks/run/robot/robot_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/scene/scene_robot.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

// Four bars in the plane of x and z: a crank of 60 mm, a coupler, a rocker, all drawn upright;
// the coupler's end is tied to the rocker's.
const std::string kFourBar =
    R"(<mujoco model="bars"><compiler angle="radian"/><option gravity="0 0 -9.81" timestep="0.001"/>
  <default><joint axis="0 1 0" damping="1e-3"/><geom contype="0" conaffinity="0" type="capsule" size=".004"/></default>
  <worldbody><body name="frame"><geom type="box" size=".01 .01 .01"/>
    <body name="crank"><joint name="crank_turn" range="-3 3"/><geom fromto="0 0 0 0 0 .06"/>
      <body name="coupler" pos="0 0 .06"><joint name="elbow"/><geom fromto="0 0 0 .18 0 .09"/></body></body>
    <body name="rocker" pos=".18 0 0"><joint name="rocker_turn"/><geom fromto="0 0 0 0 0 .15"/></body></body></worldbody>
  <equality><connect body1="coupler" body2="rocker" anchor=".18 0 .09"/></equality>
  <actuator><position name="hold" joint="crank_turn" kp="5" kv=".1" ctrlrange="-.5 .5"/></actuator>
  <keyframe><key name="turned" qpos=".3 0 0" ctrl=".3"/></keyframe></mujoco>)";

class RobotScenes : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Scene sceneOfText(const std::string& xml, const RobotSceneOptions& options = {}) {
    RobotImport import = readMjcf(write("robot.xml", xml));
    return parseScene(sceneOfRobot(import.robot, options, import.notes), folder_ / "robot.json");
  }
  static double measured(const Simulation& sim, const std::string& quantity) {
    return quantityOf(quantity, sim.scene()).measure(sim.moment());
  }
  static void run(Simulation& sim, int ticks) {
    for (int n = 0; n < ticks; ++n) ASSERT_EQ(sim.tick().status, engine::kStepOk);
  }
  // Where the coupler's end is off the rocker's [m].
  static double gap(const Simulation& sim) {
    const auto bodyNamed = [&](const std::string& name) {
      int i = 0;
      while (sim.scene().bodies[static_cast<std::size_t>(i)].name != name) ++i;
      return sim.bodyPose(i);
    };
    return (bodyNamed("coupler") * Vec3(.18, 0, .09) - bodyNamed("rocker") * Vec3(0, 0, .15)).norm();
  }

  tests::TemporaryDirectory folder_;
};

TEST_F(RobotScenes, AConnectClosesALoop) {
  Simulation sim(sceneOfText(kFourBar, {.keyframe = "turned"}));
  const double start = measured(sim, "rocker_turn.position");
  double worst = 0;
  for (int n = 0; n < 2000; ++n) {
    ASSERT_EQ(sim.tick().status, engine::kStepOk);
    worst = std::max(worst, gap(sim));
  }
  EXPECT_LT(worst, 1e-15);
  EXPECT_GT(std::abs(measured(sim, "rocker_turn.position") - start), 1e-3);  // it sags on its drive
}

TEST_F(RobotScenes, AKeyframeThatLeavesALoopOpenIsClosed) {
  Simulation sim(sceneOfText(kFourBar, {.keyframe = "turned"}));
  EXPECT_LT(gap(sim), 1e-12);
  EXPECT_GT(std::abs(measured(sim, "crank_turn.position")), 0.01);
}

TEST_F(RobotScenes, AJointThatIsGivenStaysWhereALoopIsClosed) {
  const Simulation sim(sceneOfText(kFourBar, {.start = {{"crank_turn", 0.4}}}));
  EXPECT_NEAR(measured(sim, "crank_turn.position"), 0.4, 1e-15);
  EXPECT_LT(gap(sim), 1e-12);
}

TEST_F(RobotScenes, ALoopThatCantBeClosedIsASentence) {
  const std::string message = tests::errorOf([&] {
    sceneOfText(kFourBar, {.start = {{"crank_turn", 0.4}, {"rocker_turn", -1.5}}});
  });
  EXPECT_NE(message.find("robot.xml:7: can't be closed from this pose"), std::string::npos) << message;
}

TEST_F(RobotScenes, ImportedRunAndNamedInASceneARobotGivesTheSameBits) {
  const std::string path = write("robot.xml", kFourBar);
  std::string remarks;
  Simulation as_it_is(parseScene(robotSceneText(path, remarks), folder_ / "robot.xml"));
  Simulation imported(sceneOfText(kFourBar));
  Simulation named(parseScene(R"({"version": 1, "duration": 1, "tick": 0.001, "combination": "maximum",
    "bodies": [], "robots": [{"name": "it", "file": "robot.xml"}]})",
                              folder_ / "scene.json"));
  for (Simulation* sim : {&as_it_is, &imported, &named}) run(*sim, 500);
  EXPECT_EQ(engine::hashOf(as_it_is.state().world), engine::hashOf(imported.state().world));
  EXPECT_EQ(engine::hashOf(as_it_is.state().world), engine::hashOf(named.state().world));
}

// A body's name was taken for its place among all names: the weld held another ball, and a joint's name was a body.
TEST_F(RobotScenes, BodiesBesideARobotAreFoundByTheirNames) {
  write("robot.xml", kFourBar);
  const auto scene = [&](const std::string& held) {
    std::string balls;
    for (int i = 0; i < 20; ++i)
      balls += fmt::format(R"({}{{"name": "ball{}", "shape": {{"type": "sphere", "radius": 0.01}}, "mass": 1,
        "position": [{}, 0, 1]}})",
                           i > 0 ? ", " : "", i, 1 + 0.1 * i);
    return parseScene(R"({"version": 1, "duration": 1, "robots": [{"name": "it", "file": "robot.xml"}], "bodies": [)" +
                          balls + R"(], "joints": [{"type": "weld", "body": ")" + held + R"("}]})",
                      folder_ / "scene.json");
  };
  for (const char* name : {"ball0", "ball7", "ball19"}) {
    Simulation sim(scene(name));
    run(sim, 100);
    EXPECT_NEAR(measured(sim, std::string(name) + ".p_z"), 1, 1e-12) << name;
    EXPECT_LT(measured(sim, "ball3.p_z"), 0.96) << name;
  }
  EXPECT_NE(tests::errorOf([&] { scene("it_elbow"); }).find("isn't known"), std::string::npos)
      << tests::errorOf([&] { scene("it_elbow"); });
}

// b follows a, and c follows b: q_b = 0.2 + 0.5 a + 0.25 a^2, q_c = 2 (q_b - 0.2).
const std::string kThreeInARow =
    R"(<mujoco><compiler angle="radian"/><default><joint axis="0 1 0"/><geom size=".01" pos=".02 0 0" mass="1"/></default>
  <worldbody><body name="a"><joint name="qa"/><geom/></body><body name="b" pos="0 1 0"><joint name="qb" ref=".2"/><geom/></body>
    <body name="c" pos="0 2 0"><joint name="qc"/><geom/></body></worldbody>
  <equality><joint joint1="qc" joint2="qb" polycoef="0 2"/><joint joint1="qb" joint2="qa" polycoef="0 .5 .25"/>)";

// It was refused, by names that the file doesn't have and without a line.
TEST_F(RobotScenes, WhatFollowsAFollowerFollowsTheFirst) {
  const Scene scene = sceneOfText(kThreeInARow + "</equality></mujoco>", {.start = {{"qa", 0.4}}});
  ASSERT_EQ(scene.couplings.size(), 2u);
  EXPECT_EQ(scene.couplings[0].follows, scene.couplings[1].follows);
  EXPECT_EQ(scene.couplings[0].polynomial, (std::array{0.0, 1.0, 0.5, 0.0, 0.0}));
  Simulation sim(scene);
  run(sim, 100);
  const double a = measured(sim, "qa.position"), b = 0.2 + 0.5 * a + 0.25 * a * a;
  EXPECT_GT(a, 0.41);
  EXPECT_NEAR(measured(sim, "qb.position"), b, 1e-15);
  EXPECT_NEAR(measured(sim, "qc.position"), 2 * (b - 0.2), 1e-15);
}

TEST_F(RobotScenes, FollowersThatCantBeHadAreRefusedAtTheirLine) {
  const auto complaint = [&](const std::string& more) {
    return tests::errorOf([&] { sceneOfText(kThreeInARow + "\n" + more + "</equality></mujoco>"); });
  };
  const auto expect = [&](const std::string& more, const std::string& place, const std::string& what) {
    const std::string message = complaint(more);
    EXPECT_NE(message.find(place), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  expect(R"(<joint joint1="qa" joint2="qc"/>)", "robot.xml:4: ", "follow itself");
  expect(R"(<joint joint1="qc" joint2="qa"/>)", "robot.xml:5: ", "the first is at ");
  std::string steep = kThreeInARow;
  steep.replace(steep.find("\"0 2\""), 5, "\"0 0 0 1\"");
  EXPECT_NE(tests::errorOf([&] { sceneOfText(steep + "</equality></mujoco>"); }).find("powers up to 6"),
            std::string::npos);
}

// A slider's way was in "rad or m".
TEST_F(RobotScenes, QuantitiesAreInTheUnitOfTheirJoint) {
  const Scene scene = sceneOfText(R"(<mujoco><worldbody>
    <body name="a"><joint name="slide" type="slide" axis="1 0 0"/><geom size=".01" mass="1"/></body>
    <body name="b" pos="0 1 0"><joint name="turn" axis="1 0 0"/><geom size=".01" mass="1"/></body></worldbody>
    <tendon><fixed name="both"><joint joint="slide" coef="1"/><joint joint="turn" coef="1"/></fixed></tendon>
    <actuator><motor name="push" joint="slide"/><motor name="twist" joint="turn"/><motor name="pull" tendon="both"/></actuator></mujoco>)");
  const auto unit = [&](const std::string& quantity) { return quantityOf(quantity, scene).kind->unit; };
  EXPECT_EQ(unit("slide.position"), "m");
  EXPECT_EQ(unit("slide.velocity"), "m/s");
  EXPECT_EQ(unit("slide.stop_force"), "N");
  EXPECT_EQ(unit("turn.position"), "rad");
  EXPECT_EQ(unit("turn.force"), "N m");
  EXPECT_EQ(unit("turn.load_x"), "N");
  EXPECT_EQ(unit("push.force"), "N");
  EXPECT_EQ(unit("twist.force"), "N m");
  EXPECT_EQ(unit("pull.force"), "N m or N");
}

TEST_F(RobotScenes, AControlIsCutOffAtTheEndsOfItsRange) {
  const auto crankAfter = [&](double told) {
    Scene scene = sceneOfText(kFourBar);
    scene.drives[0].control = Trajectory::throughKeyframes({{0, {told, 0, 0}, Vec3::Zero()}});
    Simulation sim(std::move(scene));
    run(sim, 1000);
    return measured(sim, "crank_turn.position");
  };
  EXPECT_EQ(crankAfter(0.5), crankAfter(7));
  EXPECT_NE(crankAfter(0.5), crankAfter(0.4));
}

// Two carriages of 1 kg on one rail, tied by a spring of 50 N/m along q_1 + q_2 that is slack at
// 0.1 m; a motor pushes the first with 2 N.
TEST_F(RobotScenes, ATendonsSpringPullsAndAJointsRangeOfForcesHolds) {
  Simulation sim(sceneOfText(R"(<mujoco><option gravity="0 0 0" timestep="0.001"/>
    <worldbody><body name="a"><joint name="slide_a" type="slide" axis="1 0 0" damping="20" actuatorfrcrange="-2 2"/><geom size=".01" mass="1"/></body>
      <body name="b" pos="0 1 0"><joint name="slide_b" type="slide" axis="1 0 0" damping="20"/><geom size=".01" mass="1"/></body></worldbody>
    <tendon><fixed name="t" stiffness="50" damping="3" springlength=".1"><joint joint="slide_a" coef="1"/><joint joint="slide_b" coef="1"/></fixed></tendon>
    <actuator><motor name="push" joint="slide_a" ctrlrange="-9 9"/></actuator><keyframe><key name="on" ctrl="7"/></keyframe></mujoco>)",
                             {.keyframe = "on"}));
  run(sim, 5000);
  // Both go apart, each braked by 20 N s/m, when the spring has 1 N; what is off that falls as exp(-4.7 t).
  EXPECT_NEAR(measured(sim, "push.force"), 2, 1e-12);
  EXPECT_NEAR(measured(sim, "slide_a.velocity"), 0.05, 1e-9);
  EXPECT_NEAR(measured(sim, "slide_b.velocity"), -0.05, 1e-9);
  EXPECT_NEAR(measured(sim, "slide_a.position") + measured(sim, "slide_b.position"), 0.1 + 1 / 50.0, 1e-9);
}

// A hand's finger that spreads and bends in the palm's edge: MuJoCo's rule of parents, whatever the number of joints.
TEST_F(RobotScenes, ABodyOfSeveralJointsDoesNotTouchItsCarrier) {
  Simulation sim(sceneOfText(R"(<mujoco><compiler angle="radian"/><option timestep="0.001"/><worldbody>
    <body name="palm"><joint name="wrist" axis="0 1 0" stiffness="20" damping="1"/><geom type="box" size=".04 .04 .01"/>
      <body name="finger" pos=".04 0 0"><joint name="spread" axis="0 0 1" damping=".01"/><joint name="bend" axis="0 1 0" damping=".01"/>
        <geom type="capsule" size=".008" fromto="0 0 0 .04 0 0"/></body></body></worldbody></mujoco>)"));
  run(sim, 100);
  EXPECT_EQ(engine::contactCount(grasp::worldOf(sim.moment().scratch)), 0);
}

// A table with a post, and a block that only the post lets through: it rests on the table.
TEST_F(RobotScenes, ExcludingAPartOfWhatStandsStillLeavesTheRest) {
  const std::string block = R"(<mujoco><option timestep="0.001"/><worldbody><geom type="plane" size="1 1 1"/>
    <body name="table" pos="0 0 .2"><geom type="box" size=".5 .5 .02"/><body name="post" pos="0 0 .1"><geom type="box" size=".1 .1 .1"/></body></body>
    <body name="block" pos="0 0 .25"><freejoint/><geom type="box" size=".05 .05 .03"/></body></worldbody>)";
  Simulation on_table(sceneOfText(block + R"(<contact><exclude body1="block" body2="post"/></contact></mujoco>)"));
  for (int n = 0; n < 300; ++n) on_table.tick();
  EXPECT_NEAR(measured(on_table, "block.p_z"), .25, 1e-6);
  Simulation through_all(sceneOfText(
      block +
      R"(<contact><exclude body1="block" body2="post"/><exclude body1="block" body2="table"/><exclude body1="world" body2="block"/></contact></mujoco>)"));
  run(through_all, 300);
  EXPECT_NEAR(measured(through_all, "block.p_z"), .25 - 9.81 * .09 / 2, 1e-9);
}

TEST_F(RobotScenes, WhatBallsAndFreeBodiesCantHaveIsCounted) {
  RobotImport import = readMjcf(write("robot.xml", R"(<mujoco><default><joint damping="1"/></default><worldbody>
    <body><joint type="ball"/><geom size=".1"/></body><body pos="1 0 0"><joint type="free"/><geom size=".1"/></body></worldbody></mujoco>)"));
  sceneOfRobot(import.robot, {}, import.notes);
  ASSERT_EQ(import.notes.all().size(), 2u);
  EXPECT_EQ(import.notes.all()[0].what, "ball joint damping");
  EXPECT_EQ(import.notes.all()[1].what, "free joint damping");
}

// A trunk with a swinging arm in free fall: its momentum is that of one free body, and turns as little.
TEST_F(RobotScenes, ARobotOnAFreeBaseFallsAsItsCentreOfMassDoes) {
  Simulation sim(sceneOfText(R"(<mujoco><compiler angle="radian"/><option timestep="0.001"/><worldbody>
    <body name="trunk" pos="0 0 2" euler=".3 .2 .1"><freejoint name="root"/><geom type="box" size=".1 .05 .03" mass="2"/>
      <body name="arm" pos=".1 0 0"><joint name="elbow" axis="0 1 0" stiffness="3" springref="1"/>
        <geom type="capsule" size=".02" fromto="0 0 0 .2 0 0" mass="1"/></body></body></worldbody></mujoco>)"));
  const auto centre = [&] {
    return Vec3((2 * Vec3(measured(sim, "trunk.p_x"), measured(sim, "trunk.p_y"), measured(sim, "trunk.p_z")) +
                 sim.bodyPose(static_cast<int>(sim.scene().bodies.size()) - 1) * Vec3(.1, 0, 0)) /
                3);
  };
  const Vec3 start = centre();
  run(sim, 400);
  EXPECT_GT(std::abs(measured(sim, "elbow.position")), .1);  // it does swing
  // The bodies of a microgram between sliders add 3e-9 kg to 3 kg where they hang on the
  // base; the sum of the path is of 4th order.
  EXPECT_LT((centre() - start - Vec3(0, 0, -9.81 * .16 / 2)).norm(), 1e-8);
}

}  // namespace
}  // namespace pincer::tasks
