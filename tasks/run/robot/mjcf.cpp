#include "pincer/tasks/run/robot/mjcf.h"

#include <filesystem>

#include "pincer/tasks/run/robot/mjcf_parts.h"

namespace pincer::tasks {
namespace mjcf {
namespace {

// Switches of whole kinds of force: what is on without saying so may be said to be on.
void readFlags(const XmlElement& element, Robot& robot) {
  const Values values(element);
  // Words of a flag, and flags whose kind of force can't be left out here.
  constexpr std::string_view kWords[] = {"disable", "enable"};
  constexpr std::string_view kNeeded[] = {"constraint", "equality", "frictionloss", "limit",    "contact",
                                          "spring",     "damper",   "clampctrl",    "actuation"};
  for (const std::string_view name : kNeeded) {
    if (values.oneOf(name, kWords, 1) == 0)
      values.reject(name, "can't be switched off as a whole here: leave out the parts themselves.");
  }
  if (values.oneOf("gravity", kWords, 1) == 0) robot.gravity_W.setZero();
}

void readOptions(const Document& document, Robot& robot) {
  for (const XmlElement* element : sections(document, "option")) {
    const Values values(*element);
    robot.tick = values.number("timestep", robot.tick);
    if (!(robot.tick > 0)) values.reject("timestep", "isn't positive.");
    robot.gravity_W = values.vector("gravity", robot.gravity_W);
  }
  for (const XmlElement* element : sections(document, "option")) {
    for (const XmlElement& child : element->children) readFlags(child, robot);
  }
}

}  // namespace
}  // namespace mjcf

RobotImport readMjcf(const std::string& path, const std::vector<std::string>& allowed_folders) {
  mjcf::Document document = mjcf::readDocument(path, allowed_folders);
  RobotImport result;
  Robot& robot = result.robot;
  const std::string* name = document.root.find("model");
  robot.name = name ? *name : std::filesystem::path(path).stem().string();
  robot.file = path;
  mjcf::readOptions(document, robot);
  mjcf::Reading reading{document, robot, {}, {}, {}};
  mjcf::readMeshes(reading);
  mjcf::readBodies(reading);
  mjcf::readRelations(reading);
  mjcf::readActuators(reading);
  mjcf::readKeyframes(reading);
  result.notes = std::move(document.notes);
  return result;
}

}  // namespace pincer::tasks
