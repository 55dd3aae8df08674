// robot_scene_parts: what the writers of a robot's scene share.
#pragma once
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/robot_links.h"
#include "pincer/tasks/run/robot/robot_shapes.h"
#include "pincer/tasks/run/robot/scene_names_of_robot.h"

namespace pincer::tasks {

struct SceneWriting {
  const PosedRobot& posed;
  ImportNotes& notes;
  NamesOfRobot names;
  RobotHulls hulls;
  JsonWriter json = {};

  const std::string& bodyName(int body) { return names.of("body", posed.body(body).name); }
};

// Throws InputError "place: problem".
[[noreturn]] void rejectAt(const Place& place, std::string_view problem);

// True if a drive moves this joint alone, and nothing else drives it: then the joint's range of forces is the drive's.
bool isOnlyDriveOf(const Robot& robot, const RobotJoint& joint);

// "material" of a part or of a pair.
void writeFriction(const RobotFriction& friction, JsonWriter& json);

// "pairs". Throws InputError at a pair whose friction can't be that of two bodies.
void writePairs(SceneWriting& writing);

// "couplings", "tendons", "drives".
void writeTies(SceneWriting& writing);

}  // namespace pincer::tasks
