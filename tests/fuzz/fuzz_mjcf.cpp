#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tests/fuzz/demand.h"
#include "pincer/tests/fuzz/input_on_disk.h"
#include "pincer/tests/fuzz/targets.h"

namespace pincer::fuzz {

// A robot's file: read, made a scene of, and that a world.
void mjcf(Bytes input) {
  static const InputOnDisk file("robot.xml");
  file.write(textOf(input));
  readsOrRefuses([&] {
    tasks::RobotImport import = tasks::readMjcf(file.path());
    tasks::buildWorld(tasks::parseScene(tasks::sceneOfRobot(import.robot, {}, import.notes), "robot.json"));
  });
}

}  // namespace pincer::fuzz
