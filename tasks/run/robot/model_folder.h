// model_folder: the files that a robot's file may name. They lie in its folder or below, or in folders that
// the user allows, whatever the file says.
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/xml_tree.h"

namespace pincer::tasks {

class ModelFolder {
 public:
  // Of the robot's file at `path`; `allowed`: further folders.
  ModelFolder(const std::string& path, const std::vector<std::string>& allowed);

  // The path of an existing file that `element` names, looked for in `folder` (relative to the model's own, or
  // absolute). Throws InputError at the element: there is none, or it lies outside.
  std::string find(const XmlElement& element, const std::string& folder, const std::string& name) const;

 private:
  std::string root_;
  std::vector<std::string> allowed_;  // canonical, the root's first
};

}  // namespace pincer::tasks
