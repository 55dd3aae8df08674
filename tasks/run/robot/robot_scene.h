// robot_scene: a robot as a scene file (docs/scenes.md): links, joints, couplings, tendons, drives, frames.
//
// Bodies that no joint lets move are part of the one that carries them, and their names become frames; what hangs on
// nothing stands still. A body of several joints gets bodies between them that weigh a microgram. Loops become balls
// and welds. Joints that don't let anything touch between their two bodies, meshes by their hulls. Names keep
// letters, digits, - and _; others become _.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

struct RobotSceneOptions {
  std::string keyframe{};  // where it starts and what its drives are told; empty: as drawn
  double duration = 2;     // [s]
  std::string prefix{};    // of all names
  Pose X_WR{};             // where the file's world stands
  // joints and their coordinates, in place of the keyframe's [rad, m]
  std::vector<std::pair<std::string, double>> start{};
};

// The scene's text (JSON). Throws InputError at the robot's file and line: what a scene can't say (a spring along a
// tendon), an unknown keyframe. Adds to the notes what is left out.
std::string sceneOfRobot(const Robot& robot, const RobotSceneOptions& options, ImportNotes& notes);

}  // namespace pincer::tasks
