#include "pincer/tasks/run/robot/mjcf.h"

#include <filesystem>

#include "pincer/tasks/run/robot/mjcf_parts.h"

namespace pincer::tasks {
namespace mjcf {
namespace {

// Each kind of force that a flag can switch off, and the parts of a robot that make it.
void switchOffContact(Robot& robot) {
  const auto let_through = [](std::vector<RobotGeom>& geoms) {
    for (RobotGeom& geom : geoms) geom.contype = geom.conaffinity = 0;
  };
  for (RobotBody& body : robot.bodies) let_through(body.geoms);
  let_through(robot.world_geoms);
}

template <class Change>
void forEachJoint(Robot& robot, Change change) {
  for (RobotBody& body : robot.bodies) {
    for (RobotJoint& joint : body.joints) change(joint);
  }
}

void switchOffLimits(Robot& robot) {
  forEachJoint(robot, [](RobotJoint& joint) { joint.limits.reset(); });
  for (RobotTendon& tendon : robot.tendons) tendon.limits.reset();
}

void switchOffFriction(Robot& robot) {
  forEachJoint(robot, [](RobotJoint& joint) { joint.friction = 0; });
  for (RobotTendon& tendon : robot.tendons) tendon.friction = 0;
}

void switchOffEqualities(Robot& robot) {
  robot.couplings.clear();
  robot.loops.clear();
}

void switchOffConstraints(Robot& robot) {
  switchOffContact(robot);
  switchOffLimits(robot);
  switchOffFriction(robot);
  switchOffEqualities(robot);
}

void switchOffSprings(Robot& robot) {
  forEachJoint(robot, [](RobotJoint& joint) { joint.stiffness = 0; });
  for (RobotTendon& tendon : robot.tendons) tendon.stiffness = 0;
}

void switchOffDampers(Robot& robot) {
  forEachJoint(robot, [](RobotJoint& joint) { joint.damping = 0; });
  for (RobotTendon& tendon : robot.tendons) tendon.damping = 0;
}

void switchOffControlRanges(Robot& robot) {
  for (RobotDrive& drive : robot.drives) drive.controls.reset();
}

void switchOffDrives(Robot& robot) {
  robot.drives.clear();
  for (RobotKeyframe& key : robot.keyframes) key.controls.clear();
}

struct Flag {
  std::string_view name;
  void (*switchOff)(Robot& robot);
};
constexpr Flag kFlags[] = {
    {"constraint", switchOffConstraints},  {"equality", switchOffEqualities},
    {"frictionloss", switchOffFriction},   {"limit", switchOffLimits},
    {"contact", switchOffContact},         {"spring", switchOffSprings},
    {"damper", switchOffDampers},          {"actuation", switchOffDrives},
    {"clampctrl", switchOffControlRanges}, {"gravity", [](Robot& robot) { robot.gravity_W.setZero(); }},
};

// After all else: parts that a flag switches off have been held against the format as all others.
void readFlags(const Document& document, Robot& robot) {
  constexpr std::string_view kWords[] = {"disable", "enable"};
  for (const XmlElement* option : sections(document, "option")) {
    for (const XmlElement& element : option->children) {
      const Values values(element);
      for (const Flag& flag : kFlags) {
        if (values.oneOf(flag.name, kWords, 1) == 0) flag.switchOff(robot);
      }
    }
  }
}

void readOptions(const Document& document, Robot& robot) {
  for (const XmlElement* element : sections(document, "option")) {
    const Values values(*element);
    robot.tick = values.number("timestep", robot.tick);
    if (!(robot.tick > 0)) values.reject("timestep", "isn't positive.");
    robot.gravity_W = values.vector("gravity", robot.gravity_W);
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
  mjcf::noteFrictionless(reading);
  mjcf::readRelations(reading);
  mjcf::readActuators(reading);
  mjcf::readKeyframes(reading);
  mjcf::readFlags(document, robot);
  result.notes = std::move(document.notes);
  return result;
}

}  // namespace pincer::tasks
