// Joints with limits, springs and drives as scenes have them: what a file
// makes, what it may not say, and that it moves.
#include <gtest/gtest.h>

#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

// A carriage on a rail with further keys of its joint, and further keys of the scene.
std::string rail(const std::string& joint, const std::string& scene = "") {
  return R"({"version": 1, "duration": 1, "gravity": [0, 0, 0],
    "bodies": [{"name": "carriage", "shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "mass": 2, "position": [0.5, 0, 0]}],
    "joints": [{"name": "rail", "type": "slider", "body": "carriage", "axis": [1, 0, 0])" +
         joint + "}]" + scene + "}";
}

std::string complaint(const std::string& json) {
  try {
    buildWorld(parseScene(json, "s.json"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double measured(const Simulation& sim, const std::string& quantity) {
  return quantityOf(quantity, sim.scene()).measure(sim.moment());
}

Simulation run(const std::string& json) {
  Simulation sim(parseScene(json, "s.json"));
  while (sim.ticks() < sim.scene().ticks()) EXPECT_EQ(sim.tick().status, engine::kStepOk);
  return sim;
}

TEST(SceneJoints, ACarriageIsDrivenHeldByFrictionAndStopped) {
  const std::string motor = R"(, "drives": [{"name": "motor", "joint": "rail", "type": "motor", "target": )";
  // F t^2/2m until the stop 0.3 m ahead.
  const Simulation free = run(rail(R"(, "limits": [-1, 0.3], "friction": 1)", motor + "1.4}]"));
  EXPECT_NEAR(measured(free, "rail.position"), 0.4 / (2 * 2), 1e-9);
  EXPECT_NEAR(measured(free, "rail.friction_force"), -1, 1e-12);
  EXPECT_NEAR(measured(free, "motor.force"), 1.4, 1e-12);
  const Simulation held = run(rail(R"(, "friction": 1)", motor + "0.9}]"));
  // round-off of a tick: 0.9 N/1 kg (1e-3 s)^2 times 1e-16, and some
  EXPECT_NEAR(measured(held, "rail.position"), 0, 1e-15);
  EXPECT_NEAR(measured(held, "rail.friction_force"), -0.9, 1e-9);
  const Simulation stopped = run(rail(R"(, "limits": [-1, 0.3])", motor + "3}]"));
  EXPECT_NEAR(measured(stopped, "rail.position"), 0.3, 1e-9);
  EXPECT_NEAR(measured(stopped, "rail.stop_force"), -3, 1e-9);
}

TEST(SceneJoints, StartSaysWhatTheJointReadsWhereTheBodiesAre) {
  const Simulation sim(parseScene(rail(R"(, "start": 0.2, "limits": [0, 0.3])"), "s.json"));
  EXPECT_NEAR(measured(sim, "rail.position"), 0.2, 1e-15);
  EXPECT_NEAR(sim.bodyPose(0).p.x(), 0.5, 1e-15);
}

// Numbers of joints that have nothing but a name are measured as well.
TEST(SceneJoints, APlainJointHasAPosition) {
  const Simulation sim(parseScene(rail(R"(, "damping": 0.1)"), "s.json"));
  EXPECT_NEAR(measured(sim, "rail.position"), 0, 1e-15);
  EXPECT_NEAR(measured(sim, "rail.velocity"), 0, 1e-15);
}

TEST(SceneJoints, FramesGoWithTheirBodies) {
  const Simulation sim = run(
      rail(R"(, "armature": 1)", R"(, "drives": [{"joint": "rail", "type": "velocity", "damping": 1e5, "target": 0.5}],
    "frames": [{"name": "tool", "body": "carriage", "position": [0, 0, 0.2]}])"));
  EXPECT_NEAR(measured(sim, "tool.p_x"), 0.5 + measured(sim, "rail.position"), 1e-12);
  EXPECT_NEAR(measured(sim, "tool.p_z"), 0.2, 1e-12);
  EXPECT_NEAR(measured(sim, "tool.v_x"), 0.5, 1e-6);
}

TEST(SceneJoints, MistakesAreNamed) {
  const auto says = [](const std::string& json, const std::string& text) {
    EXPECT_NE(complaint(json).find(text), std::string::npos) << complaint(json);
  };
  says(rail(R"(, "limits": [0.3, -1])"), "leaves no way");
  says(rail(R"(, "limits": [0.3])"), "must be [lower, upper]");
  says(rail(R"(, "limits": [0.1, 0.3])"), "is beyond a stop");
  says(rail(R"(, "friction": -1)"), "is out of range");
  says(rail("", R"(, "drives": [{"joint": "rails", "type": "motor"}])"), "Did you mean \"rail\"?");
  says(rail("", R"(, "drives": [{"type": "motor"}])"), "needs either \"joint\" or \"tendon\"");
  says(rail("", R"(, "drives": [{"joint": "rail", "type": "position"}])"), "needs \"stiffness\"");
  says(rail("", R"(, "drives": [{"joint": "rail", "type": "motor", "stiffness": 3}])"),
       "goes with drives to a position");
  says(rail("", R"(, "drives": [{"joint": "rail", "type": "motor", "force": [3, -3]}])"), "is no range");
  says(rail("", R"(, "couplings": [{"joint": "rail", "follows": "rail"}])"), "is the joint itself");
  says(rail("", R"(, "tendons": [{"name": "t", "joints": {}}])"), "must say by how much each joint counts");
  says(rail("", R"(, "record": {"quantities": ["carriage|carriage.f_x"]})"), "names one body twice");
  says(rail("", R"(, "record": {"quantities": ["rail.speed"]})"), "isn't known");
}

}  // namespace
}  // namespace pincer::tasks
