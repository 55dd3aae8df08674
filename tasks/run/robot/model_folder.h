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
  // The same of a URI: package://NAME/REST (model:// likewise), file://PATH, or a path relative to the model's folder.
  // A package is the folder NAME below or above the model's file, or the model's folder itself.
  std::string findUri(const XmlElement& element, const std::string& uri) const;

 private:
  std::string findPackaged(const XmlElement& element, const std::string& uri, const std::string& in_package) const;

  std::string root_;
  std::vector<std::string> allowed_;  // canonical, the root's first
};

}  // namespace pincer::tasks
