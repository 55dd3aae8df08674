#include "pincer/tasks/run/scene/scene_robot.h"

#include <fmt/format.h>

#include "pincer/tasks/run/robot/import_report.h"
#include "pincer/tasks/run/robot/robot_scene.h"
#include "pincer/tasks/run/scene/scene_keys.h"
#include "pincer/tasks/run/scene/scene_parts.h"

namespace pincer::tasks {
namespace {

std::string sceneText(const std::string& path, const RobotSceneOptions& options,
                      const std::vector<std::string>& allowed_folders, std::string& remarks) {
  RobotImport import = readRobotFile(path, allowed_folders);
  const std::string text = sceneOfRobot(import.robot, options, import.notes);
  if (!import.notes.all().empty()) remarks += importText(import);
  return text;
}

}  // namespace

std::string robotSceneText(const std::string& path, std::string& remarks, const RobotFileOptions& options) {
  RobotSceneOptions scene_options;
  scene_options.keyframe = options.keyframe;
  return sceneText(path, scene_options, options.allowed_folders, remarks);
}

RobotJson readRobot(const JsonValue& json, const RobotFileOptions& file_options, Scene& scene) {
  json.allowOnly(keys::kRobot);
  RobotSceneOptions options;
  if (const JsonValue* v = json.find("name")) {
    requireName(v->text(), *v);
    options.prefix = v->text() + "_";
  }
  if (const JsonValue* v = json.find("keyframe")) options.keyframe = v->text();
  if (const JsonValue* v = json.find("start")) {
    for (const std::string& joint : v->keys())
      options.start.emplace_back(joint, v->at(joint).number(ranges::kJointPosition));
  }
  options.X_WR = {quatFromRotationVector(readVector(json, "rotation", ranges::kRotation)),
                  readVector(json, "position", ranges::kCoordinate)};
  const JsonValue& file = json.at("file", "The robot's MJCF or URDF file, relative to the scene's folder.");
  const std::string path = besideScene(scene.file, file.text());
  try {
    return {options.prefix,
            parseJson(sceneText(path, options, file_options.allowed_folders, scene.remarks), path + " (as a scene)")};
  } catch (const InputError& error) {
    file.reject(fmt::format("can't be used: {}", error.what()));
  }
}

}  // namespace pincer::tasks
