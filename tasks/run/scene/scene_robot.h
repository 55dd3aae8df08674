// scene_robot: robots from their own files (docs/robots.md), as scenes and within scenes.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/robot/robot_import.h"
#include "pincer/tasks/run/scene.h"

namespace pincer::tasks {

// Settings of a user for robots' files.
struct RobotFileOptions {
  std::vector<std::string> allowed_folders;  // further ones that files may lie in
  std::string keyframe;                      // of a robot's own file: where it starts; empty: as drawn
};

// A robot's file as the text of a scene; what of it has no effect is appended to
// `remarks`, as lines for people. Throws InputError.
std::string robotSceneText(const std::string& path, std::string& remarks, const RobotFileOptions& options = {});

// sceneOf (scene.h), its robots' files in further folders.
Scene sceneOf(const JsonValue& json, const std::string& name, const RobotFileOptions& options);

// A file's text, parsed, and what it is called in messages.
struct NamedJson {
  std::string name;
  JsonValue json;
};

// One of a scene's "robots": its parts as a scene, and what their names begin with. Its remarks are
// appended to the scene's. Throws InputError.
struct RobotJson {
  std::string prefix;
  JsonValue json;
};
RobotJson readRobot(const JsonValue& json, const RobotFileOptions& file_options, Scene& scene);

}  // namespace pincer::tasks
