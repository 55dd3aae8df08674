// A robot in pincer as a contestant: its file as `pincer sim` reads it, nothing asleep.
#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/judge/bench/engine/bench_world.h"
#include "pincer/tasks/run/robot/robot_import.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/simulation.h"

namespace pincer::tasks {
namespace {

Scene sceneOfBench(const BenchRobot& robot, const BenchStep& step) {
  RobotImport import = readRobotFile(robot.file);
  RobotSceneOptions options;
  options.keyframe = robot.keyframe;
  Scene scene = parseScene(sceneOfRobot(import.robot, options, import.notes), robot.file + ".json");
  scene.options.h = step.h;
  scene.options.position_tolerance = step.tolerance;
  scene.options.max_parts = 64;
  scene.options.sleep = false;  // as with the others
  return scene;
}

class PincerRobot : public BenchEngine {
 public:
  PincerRobot(const BenchRobot& robot, const BenchStep& step) : sim_(sceneOfBench(robot, step)) {
    const std::vector<engine::BodySpec>& bodies = sim_.scene().bodies;
    for (const std::string& name : robot.bodies) {
      const auto body =
          std::find_if(bodies.begin(), bodies.end(), [&](const engine::BodySpec& spec) { return spec.name == name; });
      if (body == bodies.end()) throw InputError(fmt::format("{} has no body \"{}\".", robot.file, name));
      ids_.push_back(static_cast<int>(body - bodies.begin()));
    }
  }

  void step() override {
    const engine::StepReport report = sim_.tick();
    status_ |= report.status;
    flagged_ += report.status != engine::kStepOk;
  }

  BenchMotion motion(int i) override {
    const int id = ids_[static_cast<std::size_t>(i)];
    return {sim_.bodyPose(id), sim_.state().world.bodies[static_cast<std::size_t>(id)].v_W,
            engine::bodyAngularVelocity(sim_.model().world, sim_.state().world, id)};
  }

  std::string complaint() override {
    if (status_ == engine::kStepOk) return {};
    return fmt::format("{} of its steps were flagged (status bits {:#x})", flagged_, status_);
  }

 private:
  Simulation sim_;
  std::uint32_t status_ = engine::kStepOk;
  std::int64_t flagged_ = 0;
  std::vector<int> ids_;
};

}  // namespace

std::unique_ptr<BenchEngine> pincerRobot(const BenchRobot& robot, const BenchStep& step) {
  return std::make_unique<PincerRobot>(robot, step);
}

}  // namespace pincer::tasks
