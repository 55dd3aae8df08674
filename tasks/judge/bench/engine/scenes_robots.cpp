// Robots from MJCF files: one that moves freely, or one that holds something.
//
// A robot that moves has no exact answer. Its error is the distance from pincer's own answer at 1/32 and 1/64 ms,
// extrapolated in the square of the step; that another engine's error goes to zero with its step says that this is
// right. What is held has one: it stays.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/bench/engine/bench_scene.h"
#include "pincer/tasks/run/robot/robot_import.h"

namespace pincer::tasks {
namespace {

constexpr double kSettled = 1, kHeld = 3;     // [s]: creep is counted from, to
constexpr double kDropped = 0.01;             // [m]
constexpr double kReferenceStep = 1e-3 / 32;  // [s]
constexpr double kMicrometre = 1e-6;          // [m]

BenchScene robotScene(const std::string& name, BenchRobot robot) {
  BenchScene s;
  s.name = "robots/" + name;
  s.unit = "um";
  s.steps = {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};
  s.even = false;
  s.world.robot = std::move(robot);
  return s;
}

// The first of its bodies stays where it is; with a second one, where it is in the frame of that.
BenchScene robotHoldScene(const std::string& name, BenchRobot robot) {
  const bool carried = robot.bodies.size() > 1;
  BenchScene s = robotScene(name, std::move(robot));
  s.metric = fmt::format("largest way from {:g} to {:g} s", kSettled, kHeld);
  s.duration = kHeld;
  s.floor = 1e-10;
  s.error_bound = 1e-6;
  s.judge = [=] {
    const auto held = std::make_shared<std::optional<Vec3>>();
    const auto start = std::make_shared<std::optional<Vec3>>();
    const auto worst = std::make_shared<double>(0);
    const auto place = [=](BenchEngine& e) {
      const Vec3 p_W = e.motion(0).X_WB.p;
      return carried ? Vec3(e.motion(1).X_WB.inverse() * p_W) : p_W;
    };
    BenchJudge judge;
    judge.look = [=](double t, BenchEngine& e) {
      const Vec3 p = place(e);
      if (!*start) *start = p;
      if (t < kSettled) return true;
      if (!*held) *held = p;
      *worst = std::max(*worst, (p - **held).norm());
      return true;
    };
    judge.verdict = [=](BenchEngine& e) {
      if (!((place(e) - **start).norm() < kDropped)) return BenchVerdict{.failure = "loses it"};
      return BenchVerdict{*worst / kMicrometre};
    };
    return judge;
  };
  return s;
}

std::vector<Vec3> placesAt(double end, const BenchRobot& robot, double h) {
  const auto engine = pincerRobot(robot, {.h = h});
  for (std::int64_t i = std::llround(end / h); i > 0; --i) engine->step();
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) places.push_back(engine->motion(static_cast<int>(i)).X_WB.p);
  return places;
}

BenchScene motionScene(const std::string& name, const BenchRobot& robot, double end = 0.5) {
  BenchScene s = robotScene(name, robot);
  s.metric = fmt::format("places at {:g} s, largest error", end);
  s.duration = end;
  s.floor = 1e-5;
  s.error_bound = 0.1;
  const auto exact = std::make_shared<std::vector<Vec3>>();
  s.judge = [=] {
    if (exact->empty()) {
      *exact = placesAt(end, robot, 0.5 * kReferenceStep);
      const std::vector<Vec3> coarse = placesAt(end, robot, kReferenceStep);
      for (std::size_t i = 0; i < coarse.size(); ++i) (*exact)[i] += ((*exact)[i] - coarse[i]) / 3;
    }
    return judgeOfEnd([=](BenchEngine& e) {
      double worst = 0;
      for (std::size_t i = 0; i < exact->size(); ++i)
        worst = std::max(worst, (e.motion(static_cast<int>(i)).X_WB.p - (*exact)[i]).norm());
      return BenchVerdict{worst / kMicrometre};
    });
  };
  return s;
}

// A file of the user's: what is free in it and carries nothing is held, or else the last links of its branches are
// followed.
BenchScene sceneOfModel(const std::filesystem::path& path) {
  const Robot robot = readRobotFile(path.string()).robot;
  BenchRobot held{path.string(), robot.keyframes.empty() ? "" : robot.keyframes.front().name, {}}, ends = held;
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    const RobotBody& body = robot.bodies[i];
    const auto hangs_on_it = [&](const RobotBody& b) { return b.parent == static_cast<int>(i) && !b.joints.empty(); };
    if (body.joints.empty() || std::any_of(robot.bodies.begin(), robot.bodies.end(), hangs_on_it)) continue;
    const bool is_free = body.joints.front().kind == RobotJointKind::kFree;
    (is_free ? held : ends).bodies.push_back(body.name);
  }
  held.bodies.resize(std::min<std::size_t>(held.bodies.size(), 1));
  BenchScene s =
      held.bodies.empty() ? motionScene(path.stem().string(), ends) : robotHoldScene(path.stem().string(), held);
  s.error_bound = kInfinity;  // nothing is promised of it
  return s;
}

}  // namespace

std::vector<BenchScene> benchRobotScenes(const std::string& models) {
  const auto carried = [](const char* file) { return std::string("(built-in)/") + file; };
  std::vector<BenchScene> scenes = {
      motionScene("arm-swings", {carried("bench_arm.xml"), "start", {"hand"}}),
      motionScene("linkage-opens", {carried("bench_linkage.xml"), "start", {"left", "right"}}),
      motionScene("hand-opens", {carried("bench_hand.xml"), "start", {"tip0", "tip1", "tip2"}}, 0.1),
      robotHoldScene("gripper-holds", {carried("bench_gripper.xml"), "start", {"cube"}}),
      robotHoldScene("linkage-holds", {carried("bench_linkage_cube.xml"), "start", {"cube"}}),
      robotHoldScene("hand-holds", {carried("bench_hand_ball.xml"), "start", {"ball"}}),
      robotHoldScene("arm-carries", {carried("bench_arm_box.xml"), "start", {"box", "hand"}})};
  if (models.empty()) return scenes;
  std::vector<std::filesystem::path> files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(models, failure))
    if (isRobotFile(entry.path().string())) files.push_back(entry.path());
  if (failure) throw InputError(fmt::format("--models: {}: {}.", models, failure.message()));
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) scenes.push_back(sceneOfModel(file));
  return scenes;
}

}  // namespace pincer::tasks
