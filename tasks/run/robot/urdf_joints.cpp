// joint: kinds of joints, their axes, limits and dynamics.
#include <fmt/format.h>

#include "pincer/tasks/run/robot/urdf_parts.h"

namespace pincer::tasks::urdf {
namespace {

// By JointType.
constexpr std::string_view kTypes[] = {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"};

std::string linkOf(const XmlElement& joint, std::string_view tag) {
  const XmlElement* element = onlyChild(joint, tag);
  if (!element) joint.reject(fmt::format("needs a <{}>.", tag));
  return XmlValues(*element).required("link");
}

Vec3 readAxis(const XmlElement& joint) {
  const XmlElement* element = onlyChild(joint, "axis");
  if (!element) return Vec3::UnitX();
  const XmlValues values(*element);
  const Vec3 axis = values.vector("xyz", Vec3::UnitX());
  if (!(axis.norm() > 0)) values.reject("xyz", "has no length.");
  return axis.normalized();
}

Vec2 readLimits(const Joint& joint) {
  const XmlElement* element = onlyChild(*joint.element, "limit");
  if (!element)
    joint.element->reject(fmt::format("\"{}\" is {} and needs a <limit>. What turns without end is of type continuous.",
                                      joint.name, kTypes[static_cast<int>(joint.type)]));
  const XmlValues values(*element);
  const Vec2 limits(values.number("lower", 0), values.number("upper", 0));
  if (limits[0] > limits[1])
    element->reject(fmt::format("has its limits upside down: lower {:g} is above upper {:g}.", limits[0], limits[1]));
  if (limits[0] == limits[1])
    element->reject(
        fmt::format("leaves joint \"{}\" no way: both ends are {:g} (0 where they are missing). Give it a "
                    "range, or make it of type fixed or continuous.",
                    joint.name, limits[0]));
  return limits;
}

void readDynamics(const Joint& joint, RobotJoint& axis) {
  const XmlElement* element = onlyChild(*joint.element, "dynamics");
  if (!element) return;
  const XmlValues values(*element);
  axis.damping = values.number("damping", 0);
  axis.friction = values.number("friction", 0);
  if (!(axis.damping >= 0)) values.reject("damping", "is negative. A damper brakes.");
  if (!(axis.friction >= 0)) values.reject("friction", "is negative; 0 is none.");
}

void readMimic(Joint& joint) {
  const XmlElement* element = onlyChild(*joint.element, "mimic");
  if (!element) return;
  if (joint.type != JointType::kRevolute && joint.type != JointType::kContinuous && joint.type != JointType::kPrismatic)
    element->reject(fmt::format("goes with joints of one coordinate, and \"{}\" is {}.", joint.name,
                                kTypes[static_cast<int>(joint.type)]));
  const XmlValues values(*element);
  joint.leader = values.required("joint");
  joint.multiplier = values.number("multiplier", 1);
  joint.offset = values.number("offset", 0);
}

}  // namespace

Joint readJointHeader(const XmlElement& element) {
  const XmlValues values(element);
  Joint joint{&element, values.required("name"), JointType::kFixed, {}, {}, {}};
  values.required("type");
  joint.type = static_cast<JointType>(values.oneOf("type", kTypes, 0));
  joint.parent = linkOf(element, "parent");
  joint.child = linkOf(element, "child");
  if (joint.parent == joint.child)
    element.reject(fmt::format("\"{}\" holds link \"{}\" to itself.", joint.name, joint.child));
  readMimic(joint);
  return joint;
}

std::vector<RobotJoint> readAxes(const Joint& joint) {
  RobotJoint axis;
  axis.name = joint.name;
  axis.place = joint.element->place();
  axis.axis_B = readAxis(*joint.element);
  readDynamics(joint, axis);
  switch (joint.type) {
    case JointType::kFixed:
      return {};
    case JointType::kFloating:
      axis.kind = RobotJointKind::kFree;
      return {axis};
    case JointType::kContinuous:
      return {axis};
    case JointType::kRevolute:
      axis.limits = readLimits(joint);
      return {axis};
    case JointType::kPrismatic:
      axis.kind = RobotJointKind::kSlide;
      axis.limits = readLimits(joint);
      return {axis};
    case JointType::kPlanar:
      break;
  }
  // Across the axis, which is the plane's normal: of z these are x and y.
  const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), axis.axis_B).normalized();
  RobotJoint x = axis, y = axis;
  x.kind = y.kind = RobotJointKind::kSlide;
  x.name += "_x";
  y.name += "_y";
  x.axis_B = q * Vec3::UnitX();
  y.axis_B = q * Vec3::UnitY();
  return {x, y, axis};
}

}  // namespace pincer::tasks::urdf
