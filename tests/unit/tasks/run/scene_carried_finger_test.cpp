// Fingers that a body carries ("on"): they press as their springs say, their body feels it, and what can't be said is
// refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tasks/run/simulation.h"
#include "pincer/tests/support/error_of.h"

namespace pincer::tasks {
namespace {

double readOf(const Simulation& sim, const std::string& quantity) {
  return quantityOf(quantity, sim.scene()).measure(sim.moment());
}

// A carriage of 2 kg on a rail along x, pushed with 1.5 N; its finger, 1 mm before a wall, with these keys.
std::string carriageScene(const std::string& finger, const std::string& on = "carriage") {
  return R"({"version": 1, "duration": 8, "gravity": [0, 0, 0], "bodies": [
      {"name": "wall", "static": true, "shape": {"type": "box", "size": [0.02, 0.2, 0.2]}, "position": [0.3, 0, 0]},
      {"name": "carriage", "shape": {"type": "box", "size": [0.1, 0.1, 0.1]}, "mass": 2, "position": [0.2, 0, 0]}],
    "joints": [{"name": "rail", "type": "slider", "body": "carriage", "axis": [1, 0, 0], "damping": 40}],
    "drives": [{"name": "motor", "joint": "rail", "type": "motor", "target": 1.5}],
    "fingers": [{"name": "tip", "on": ")" +
         on + "\"" + finger + "}]}";
}
const std::string kTipPlace = R"(, "position": [0.081, 0, 0])";  // its ball of 8 mm ends at 0.289

Simulation runCarriage(const std::string& json) {
  Simulation sim(parseScene(json, "s.json"));
  while (sim.ticks() < sim.scene().ticks()) EXPECT_EQ(sim.tick().status, engine::kStepOk) << sim.time();
  return sim;
}

TEST(CarriedFinger, PressesAsItsSpringSaysAndItsBodyFeelsIt) {
  constexpr double kRested = 4e-14;  // [m]; as near as what slows down to some ulps per tick comes (linkNoise)
  for (const double k : {200.0, 1000.0, 5e4}) {
    for (const char* more : {"", R"(, "mass": 0.01)", R"(, "locked": ["y", "z"])",
                             R"(, "shape": {"type": "capsule", "radius": 0.008, "half": [0, 0.01, 0]})"}) {
      const Simulation sim = runCarriage(carriageScene(kTipPlace + fmt::format(R"(, "stiffness": {})", k) + more));
      EXPECT_NEAR(readOf(sim, "wall|tip.normal_force"), 1.5, 1e-9 + k * kRested) << k << more;
      EXPECT_NEAR(readOf(sim, "tip_x.position"), -1.5 / k, 1e-12) << k << more;
      EXPECT_NEAR(readOf(sim, "carriage.p_x"), 0.2 + 1e-3 + 1.5 / k, 1e-9) << k << more;
    }
  }
}

// A weight lowers a finger on a post as much as a finger of a hand that rests.
TEST(CarriedFinger, BearsAWeightAsAHandsFingerDoes) {
  const auto sag = [](const std::string& finger) {
    const Simulation sim = runCarriage(R"({"version": 1, "duration": 3, "bodies": [
        {"name": "post", "static": true, "shape": {"type": "box", "size": [0.02, 0.02, 0.02]}, "rotation": [0, 0.3, 0]},
        {"name": "weight", "shape": {"type": "box", "size": [0.1, 0.1, 0.02]}, "mass": 0.2, "position": [0, 0, 0.118]}],
      "joints": [{"name": "rail", "type": "slider", "body": "weight", "axis": [0, 0, 1], "friction": 1e-9}],
      "fingers": [{"name": "tip", "stiffness": 800)" +
                                       finger + "}]}");
    return 0.118 - readOf(sim, "weight.p_z");
  };
  const double hand = sag(R"(, "position": [0, 0, 0.1])");
  EXPECT_NEAR(hand, 0.2 * 9.81 / 800, 1e-9);
  // The post leans: the finger's place and axes are those of its body.
  const std::string place = fmt::format("[{}, 0, {}]", -0.1 * std::sin(0.3), 0.1 * std::cos(0.3));
  EXPECT_NEAR(sag(R"(, "on": "post", "rotation": [0, -0.3, 0], "position": )" + place), hand, 1e-8);
}

TEST(CarriedFinger, RefusesWhatOnlyAHandsFingerHas) {
  const auto complaint = [](const std::string& finger, const std::string& on = "carriage") {
    return tests::errorOf([&] { buildWorld(parseScene(carriageScene(finger, on), "s.json")); });
  };
  for (const char* keys :
       {R"(, "trajectory": {"keyframes": []})", R"(, "method": "penalty")", R"(, "patch_radius": 0.003)",
        R"(, "turn_stiffness": 1)", R"(, "taxels": {"rows": 2, "columns": 2})", R"(, "arm": {})"})
    EXPECT_NE(complaint(kTipPlace + keys).find("doesn't go with \"on\""), std::string::npos)
        << complaint(kTipPlace + keys);
  EXPECT_NE(complaint("").find("lacks the key \"position\""), std::string::npos) << complaint("");
  EXPECT_NE(complaint(kTipPlace, "carrage").find("carriage"), std::string::npos) << complaint(kTipPlace, "carrage");
  EXPECT_NE(complaint(kTipPlace, "rail").find("rail"), std::string::npos) << complaint(kTipPlace, "rail");
  const std::string locked = complaint(kTipPlace + R"(, "locked": ["x", "y", "z"])");
  EXPECT_NE(locked.find("leaves nothing to give way"), std::string::npos) << locked;
  const std::string loose = complaint(kTipPlace + R"(, "stiffness": [0, 100, 100])");
  EXPECT_NE(loose.find("has no stiffness along x"), std::string::npos) << loose;
  const std::string pad = complaint(kTipPlace + R"(, "shape": {"type": "ellipsoid", "semi_axes": [0.01, 0.01, 0.01]})");
  EXPECT_NE(pad.find("can't be carried"), std::string::npos) << pad;
  std::string twice = carriageScene(kTipPlace);
  twice.replace(twice.find("\"motor\""), 7, "\"tip_y\"");
  const std::string taken = tests::errorOf([&] { parseScene(twice, "s.json"); });
  EXPECT_NE(taken.find("can't be called \"tip_y\""), std::string::npos) << taken;
  const std::string material = tests::errorOf([&] {
    parseScene(R"({"version": 1, "duration": 1, "bodies": [], "fingers": [{"position": [0, 0, 0], "material": {}}]})",
               "s.json");
  });
  EXPECT_NE(material.find("goes with \"on\" only"), std::string::npos) << material;
}

// A robot that the program carries is read wherever the program is run.
TEST(BuiltinScenes, ThoseOfRobotsNeedNoFile) {
  for (const char* name : {"arm_stacks", "robot_grip", "takeover"}) {
    const Scene by_name = readBuiltinScene(name),
                by_path = readScene(fmt::format("{}/tasks/scenes/files/{}.json", PINCER_SOURCE_DIR, name));
    Simulation one(by_name), other(by_path);
    for (int n = 0; n < 100; ++n) {
      one.tick();
      other.tick();
    }
    EXPECT_EQ(engine::hashOf(one.state().world), engine::hashOf(other.state().world)) << name;
  }
}

// A free brick whose centre of mass isn't its origin, thrown and spinning, with a finger far from all else: together
// they fall as one body would, and turn about their centre.
TEST(CarriedFinger, OnAFreeBodyLeavesItFree) {
  for (const char* mass : {"", R"(, "mass": 0.02)"}) {
    Simulation sim(parseScene(fmt::format(R"({{"version": 1, "duration": 0.5, "bodies": [
        {{"name": "brick", "mass": 0.3, "position": [0, 0, 1], "rotation": [0.2, 0.4, -0.3], "velocity": [0.4, -0.2, 1],
          "angular_velocity": [1, 2, -3], "shapes": [
          {{"shape": {{"type": "box", "size": [0.1, 0.04, 0.06]}}, "position": [0.03, 0.01, 0]}}]}}],
        "fingers": [{{"name": "tip", "on": "brick", "position": [0.1, 0, 0], "stiffness": 500, "damping": 2{}}}]}})",
                                          mass),
                              "s.json"));
    const auto momentum = [&] {
      Vec3 sum = Vec3::Zero();
      const Moment moment = sim.moment();
      for (std::size_t i = 0; i < moment.state.world.bodies.size(); ++i)
        sum += sim.model().world.bodies[i].mass * moment.state.world.bodies[i].v_W;
      return sum;
    };
    double weight = 0;
    for (const engine::BodyModel& body : sim.model().world.bodies) weight += body.mass * 9.81;
    const Vec3 start = momentum();
    EXPECT_NEAR(sim.moment().state.world.bodies[0].v_W.x(), 0.4, 1e-12);
    EXPECT_NEAR(sim.moment().state.world.bodies[0].v_W.z(), 1, 1e-12);
    while (sim.ticks() < sim.scene().ticks()) ASSERT_EQ(sim.tick().status, engine::kStepOk) << sim.time();
    // Two of the micrograms between it and the world don't fall.
    EXPECT_LT((momentum() - start - Vec3(0, 0, -weight * 0.5)).norm(), 2e-9 * 9.81 * 0.5 + 1e-12) << mass;
    EXPECT_GT(readOf(sim, "brick.rotation"), 0.5);
  }
}

// It comes down on its finger, and rests.
TEST(CarriedFinger, OnAFreeBodyBearsIt) {
  Simulation sim(parseScene(R"({"version": 1, "duration": 4, "bodies": [
      {"name": "floor", "static": true, "shape": {"type": "half_space"}},
      {"name": "foot", "shape": {"type": "box", "size": [0.1, 0.1, 0.02]}, "mass": 0.2, "position": [0, 0, 0.05]}],
    "fingers": [
      {"name": "a", "on": "foot", "position": [0.03, 0.03, -0.02], "stiffness": 800, "damping": 8, "radius": 0.005},
      {"name": "b", "on": "foot", "position": [-0.03, 0.03, -0.02], "stiffness": 800, "damping": 8, "radius": 0.005},
      {"name": "c", "on": "foot", "position": [0, -0.03, -0.02], "stiffness": 800, "damping": 8, "radius": 0.005}]})",
                            "s.json"));
  while (sim.ticks() < sim.scene().ticks()) sim.tick();
  EXPECT_NEAR(readOf(sim, "floor|a.f_z") + readOf(sim, "floor|b.f_z") + readOf(sim, "floor|c.f_z"), -0.2 * 9.81, 1e-6);
  EXPECT_LT(readOf(sim, "foot.speed"), 1e-9);
  EXPECT_NEAR(readOf(sim, "foot.p_z"), 0.025 - 0.375 * 0.2 * 9.81 / 800, 1e-5);  // a and b bear a quarter each, c half
}

}  // namespace
}  // namespace pincer::tasks
