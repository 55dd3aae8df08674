#include "pincer/tasks/run/robot/robot_import.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/input_on_disk.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {
namespace {

// A robot's file: read, made a scene of, and that a world.
void robot(const InputOnDisk& file, Bytes input) {
  file.write(textOf(input));
  readsOrRefuses([&] {
    tasks::RobotImport import = tasks::readRobotFile(file.path());
    tasks::buildWorld(tasks::parseScene(tasks::sceneOfRobot(import.robot, {}, import.notes), "robot.json"));
  });
}

}  // namespace

void mjcf(Bytes input) {
  static const InputOnDisk file("robot.xml");
  robot(file, input);
}

void urdf(Bytes input) {
  static const InputOnDisk file("robot.urdf");
  robot(file, input);
}

}  // namespace pincer::fuzz
