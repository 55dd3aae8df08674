// builtin_files: the robots' files that scenes of the program name (run/scene/builtin_scenes.h), which it carries with
// it as well. Their paths begin with a folder that is no folder, so that no file of a user is meant.
#pragma once
#include <span>
#include <string_view>

namespace pincer::tasks {

struct BuiltinFile {
  std::string_view path;  // as the scene's path and the name in it make it
  std::string_view text;
};

std::span<const BuiltinFile> builtinFiles();

}  // namespace pincer::tasks
