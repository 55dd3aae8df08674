// robot_import: a robot from its file, whatever the format.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

struct RobotImport {
  Robot robot;
  ImportNotes notes;
};

// True for the files that robots come in: .xml and .mjcf (MJCF), .urdf; and .xacro, whose refusal says how it becomes
// URDF.
bool isRobotFile(const std::string& path);

// By the file's ending: readUrdf for .urdf and .xacro, else readMjcf. Throws InputError.
RobotImport readRobotFile(const std::string& path, const std::vector<std::string>& allowed_folders = {});

}  // namespace pincer::tasks
