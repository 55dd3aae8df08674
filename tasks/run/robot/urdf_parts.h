// urdf_parts: what the readers of a URDF file's elements share.
#pragma once
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/model_folder.h"
#include "pincer/tasks/run/robot/robot.h"
#include "pincer/tasks/run/robot/xml_values.h"

namespace pincer::tasks::urdf {

// The first child of that tag, null where there is none. Throws InputError at a second one.
const XmlElement* onlyChild(const XmlElement& element, std::string_view tag);

// Reads what links hold: masses, shapes, meshes.
class LinkReader {
 public:
  LinkReader(const ModelFolder& folder, Robot& robot, ImportNotes& notes)
      : folder_(folder), robot_(robot), notes_(notes) {}

  // The element's <origin>; the identity where it has none.
  Pose readOrigin(const XmlElement& element);
  // Without parent, pose and joints.
  RobotBody readLink(const XmlElement& element);

 private:
  engine::MassProperties readInertial(const XmlElement& element);
  RobotGeom readCollision(const XmlElement& element);
  void readShape(const XmlElement& element, RobotGeom& geom);
  int meshOf(const XmlElement& element);

  const ModelFolder& folder_;
  Robot& robot_;
  ImportNotes& notes_;
  std::map<std::tuple<std::string, double, double, double>, int> meshes_;  // by file and scale
};

enum class JointType { kRevolute, kContinuous, kPrismatic, kFixed, kFloating, kPlanar };

struct Joint {
  const XmlElement* element;
  std::string name;
  JointType type;
  std::string parent, child;
  std::string leader;  // of a mimic joint
  double multiplier = 1, offset = 0;
};

// Name, type, links and mimic. Throws InputError.
Joint readJointHeader(const XmlElement& element);

// The joints of a body that move it as this one does: none of a fixed joint, two sliders and a hinge of a planar one.
std::vector<RobotJoint> readAxes(const Joint& joint);

}  // namespace pincer::tasks::urdf
