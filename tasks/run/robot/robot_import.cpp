#include "pincer/tasks/run/robot/robot_import.h"

#include <filesystem>

#include "pincer/tasks/run/robot/mjcf.h"
#include "pincer/tasks/run/robot/urdf.h"

namespace pincer::tasks {
namespace {

bool isUrdf(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return ending == ".urdf" || ending == ".xacro";
}

}  // namespace

bool isRobotFile(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return isUrdf(path) || ending == ".xml" || ending == ".mjcf";
}

RobotImport readRobotFile(const std::string& path, const std::vector<std::string>& allowed_folders) {
  return isUrdf(path) ? readUrdf(path, allowed_folders) : readMjcf(path, allowed_folders);
}

}  // namespace pincer::tasks
