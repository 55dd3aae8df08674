#include "pincer/tasks/run/robot/scene_names_of_robot.h"

#include <algorithm>

namespace pincer::tasks {
namespace {

constexpr std::size_t kLongest = 60;  // letters; a scene takes 64, and a number may follow

bool isPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

}  // namespace

const std::string& NamesOfRobot::of(const std::string& kind, const std::string& name) {
  const auto [at, is_new] = names_.try_emplace({kind, name});
  if (!is_new) return at->second;
  std::string plain = (prefix_ + name).substr(0, kLongest);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return !isPlain(c); }, '_');
  if (plain.empty()) plain = kind;
  std::string unique = plain;
  for (int n = 2; !taken_.insert(unique).second; ++n) unique = plain + "_" + std::to_string(n);
  return at->second = unique;
}

}  // namespace pincer::tasks
