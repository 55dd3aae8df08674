// scene_names_of_robot: the names that a robot's parts get in a scene: those of the file, of
// letters that a scene takes, each one once.
#pragma once
#include <map>
#include <set>
#include <string>

namespace pincer::tasks {

class NamesOfRobot {
 public:
  explicit NamesOfRobot(std::string prefix) : prefix_(std::move(prefix)) {}

  // The name in the scene of a part: letters, digits, - and _; with a number behind it where it is taken. The same part
  // has the same name again: parts are told apart by `kind` and `name`.
  const std::string& of(const std::string& kind, const std::string& name);

 private:
  std::string prefix_;
  std::map<std::pair<std::string, std::string>, std::string> names_;
  std::set<std::string> taken_;
};

}  // namespace pincer::tasks
