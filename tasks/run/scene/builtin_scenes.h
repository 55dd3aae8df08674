// builtin_scenes: the scenes of tasks/scenes, which the program carries with it, so that verify, benchmarks and `pincer
// sim NAME` find them wherever it is installed.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "pincer/tasks/run/files/strict_json.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/scene_robot.h"

namespace pincer::tasks {

struct BuiltinScene {
  std::string_view name;  // of the file, without .json
  std::string_view file;  // its name in messages; of one that names a robot beside that (builtin_files.h)
  std::string_view json;
};

// The format of scenes, for editors: docs/scene.schema.json.
std::string_view sceneSchema();

// In the order of their names.
std::span<const BuiltinScene> builtinScenes();

// Throws InputError with the names when there is none of this name.
Scene readBuiltinScene(std::string_view name);

// The path of a scene or robot (.xml), or the name of a built-in scene: what a user gives to `sim` and `plan`. A
// file of that path wins. Throws InputError; also where a keyframe is named, and it is no robot's file.
Scene readSceneOrBuiltin(const std::string& path_or_name, const RobotFileOptions& options = {});

// The same, not yet read (sceneOf), and what it is called in messages.
NamedJson parseSceneOrBuiltin(const std::string& path_or_name);
// And its text.
std::string sceneText(const std::string& path_or_name);

}  // namespace pincer::tasks
