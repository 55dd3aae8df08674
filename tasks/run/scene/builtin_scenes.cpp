#include "pincer/tasks/run/scene/builtin_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/files/file_limits.h"
#include "pincer/tasks/run/files/spelling.h"

namespace pincer::tasks {
namespace {

const BuiltinScene* findBuiltin(std::string_view name) {
  const auto scenes = builtinScenes();
  const auto found =
      std::find_if(scenes.begin(), scenes.end(), [&](const BuiltinScene& scene) { return scene.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

std::string suggestedScene(std::string_view name) {
  std::vector<std::string_view> names;
  for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
  return suggestion(name, names);
}

const BuiltinScene& builtinNamed(std::string_view name) {
  const BuiltinScene* scene = findBuiltin(name);
  if (!scene) throw InputError(fmt::format("there is no built-in scene \"{}\".{}", name, suggestedScene(name)));
  return *scene;
}

NamedJson parseBuiltin(std::string_view name) {
  const BuiltinScene& scene = builtinNamed(name);
  const std::string file(scene.file);
  return {file, parseJson(scene.json, file)};
}

}  // namespace

Scene readBuiltinScene(std::string_view name) {
  const NamedJson scene = parseBuiltin(name);
  return sceneOf(scene.json, scene.name);
}

namespace {

bool isFile(const std::string& path_or_name) {
  const bool is_word = path_or_name.find_first_of("/.") == std::string::npos;
  return !is_word || std::filesystem::exists(path_or_name);
}

}  // namespace

NamedJson parseSceneOrBuiltin(const std::string& path_or_name) {
  if (isRobotFile(path_or_name))
    return {path_or_name, parseJson(sceneText(path_or_name), path_or_name + " (as a scene)")};
  if (isFile(path_or_name)) return {path_or_name, readJson(path_or_name, kSceneFile)};
  return parseBuiltin(path_or_name);
}

std::string sceneText(const std::string& path_or_name) {
  std::string remarks;
  if (isRobotFile(path_or_name)) return robotSceneText(path_or_name, remarks);
  if (isFile(path_or_name)) return readInputFile(path_or_name, kSceneFile);
  return std::string(builtinNamed(path_or_name).json);
}

Scene readSceneOrBuiltin(const std::string& path_or_name, const RobotFileOptions& options) {
  if (isRobotFile(path_or_name)) {
    std::string remarks;
    const std::string name = path_or_name + " (as a scene)";
    Scene scene = sceneOf(parseJson(robotSceneText(path_or_name, remarks, options), name), name);
    scene.remarks = remarks;
    return scene;
  }
  if (!options.keyframe.empty())
    throw InputError(fmt::format("{}: --keyframe goes with a robot's own file. A scene names it: \"keyframe\": \"{}\".",
                                 path_or_name, options.keyframe));
  const NamedJson scene = parseSceneOrBuiltin(path_or_name);
  return sceneOf(scene.json, scene.name, options);
}

}  // namespace pincer::tasks
