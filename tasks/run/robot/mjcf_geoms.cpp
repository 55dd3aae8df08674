// Geoms and joints of a body.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_parts.h"
#include "pincer/tasks/run/robot/robot_mass.h"

namespace pincer::tasks::mjcf {
namespace {

// By RobotShape, and by the kind of joint: MJCF's words.
constexpr std::string_view kGeomTypes[] = {"plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"};
constexpr std::string_view kJointTypes[] = {"hinge", "slide", "ball", "free"};
constexpr double kDensity = 1000;  // [kg/m^3], MJCF's

// How many numbers the size of a geom has, without and with fromto.
std::size_t sizesOf(RobotShape shape, bool from_to) {
  if (shape == RobotShape::kPlane || shape == RobotShape::kMesh) return 0;
  if (shape == RobotShape::kSphere || from_to) return 1;
  return shape == RobotShape::kCapsule || shape == RobotShape::kCylinder ? 2 : 3;
}

void readSize(const Values& values, RobotGeom& geom, bool from_to) {
  const std::size_t count = sizesOf(geom.shape, from_to);
  if (count == 0) return;
  const std::vector<double> size = values.numbers("size", 1, 3);
  if (size.size() < count)
    values.element().reject(
        fmt::format("of type {} needs a size of {} numbers.", kGeomTypes[static_cast<int>(geom.shape)], count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!(size[i] > 0)) values.reject("size", fmt::format("has {}, and sizes are positive.", size[i]));
    geom.half[static_cast<Eigen::Index>(i)] = size[i];
  }
}

void readFromTo(const Values& values, RobotGeom& geom) {
  const auto [X, half] = readEnds(values);
  geom.X_BG = X;
  switch (geom.shape) {
    case RobotShape::kCapsule:
    case RobotShape::kCylinder:
      geom.half[1] = half;
      return;
    case RobotShape::kEllipsoid:
    case RobotShape::kBox:
      geom.half = {geom.half[0], geom.half[0], half};
      return;
    default:
      values.reject("fromto", "goes with capsules, cylinders, ellipsoids and boxes only.");
  }
}

int meshNamed(const Reading& reading, const Values& values) {
  const std::string name = values.required("mesh");
  if (const auto at = reading.meshes.find(name); at != reading.meshes.end()) return at->second;
  std::vector<std::string_view> names;
  for (const auto& [known, index] : reading.meshes) names.push_back(known);
  values.reject("mesh", fmt::format("is the name of no mesh of <asset>.{}", suggestion(name, names)));
}

// The friction that a geom without any would give those that have some: the larger of the two counts.
double readFriction(const Values& values, RobotGeom& geom) {
  const std::vector<double> friction = values.numbers("friction", 1, 3);
  Vec3 f(1, 0.005, 0.0001);
  for (std::size_t i = 0; i < friction.size(); ++i) f[static_cast<Eigen::Index>(i)] = friction[i];
  if (f.minCoeff() < 0) values.reject("friction", "has a negative coefficient.");
  const int dimensions = values.whole("condim", 3);
  requireDimensions(values, dimensions);
  geom.friction = frictionOf(dimensions, f);
  return dimensions == 1 ? f[0] : 0;
}

void readMass(const Reading& reading, const Values& values, RobotGeom& geom) {
  if (geom.shape == RobotShape::kPlane) return;
  if (values.boolean("shellinertia", false))
    values.reject("shellinertia", "isn't known here: give the body an <inertial>, or a mesh inertia=\"shell\".");
  geom.mass = values.has("mass") ? values.number("mass", 0)
                                 : values.number("density", kDensity) * geomVolume(geom, reading.robot.meshes);
  if (!(geom.mass >= 0)) values.reject(values.has("mass") ? "mass" : "density", "gives a negative mass.");
}

// Stiffness and damping may be polynomials there; here they are constants.
double readConstant(const Values& values, std::string_view name) {
  const std::vector<double> v = values.numbers(name, 1, 3);
  for (std::size_t i = 1; i < v.size(); ++i) {
    if (v[i] != 0) values.reject(name, "isn't linear. Springs and dampers are, here: keep the first number.");
  }
  if (!v.empty() && !(v[0] >= 0)) values.reject(name, "is negative. A spring pulls back, a damper brakes.");
  return v.empty() ? 0 : v[0];
}

double positiveOrZero(const Values& values, std::string_view name) {
  const double value = values.number(name, 0);
  if (!(value >= 0)) values.reject(name, "is negative; 0 is none.");
  return value;
}

}  // namespace

void requireDimensions(const Values& values, int dimensions) {
  if (dimensions != 1 && dimensions != 3 && dimensions != 4 && dimensions != 6)
    values.reject("condim", "is none of 1, 3, 4, 6.");
}

RobotFriction frictionOf(int dimensions, const Vec3& f) {
  RobotFriction friction{dimensions == 1 ? 0 : f[0], 0, 0};
  if (friction.mu > 0 && dimensions >= 4) friction.torsion_radius = f[1] / f[0];
  if (friction.mu > 0 && dimensions == 6) friction.rolling_radius = f[2] / f[0];
  return friction;
}

Ends readEnds(const Values& values) {
  const std::vector<double> ends = values.numbers("fromto", 6, 6);
  const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]), way = from - to;
  if (!(way.norm() > 0)) values.reject("fromto", "has both ends at one place.");
  return {{Quat::FromTwoVectors(Vec3::UnitZ(), way).normalized(), 0.5 * (from + to)}, 0.5 * way.norm()};
}

RobotGeom readGeom(Reading& reading, const Values& values, const Pose& X_BR) {
  RobotGeom geom;
  geom.place = values.element().place();
  geom.name = values.element().find("name") ? values.text("name") : "";
  const int fallback = values.has("mesh") && !values.has("type") ? static_cast<int>(RobotShape::kMesh)
                                                                 : static_cast<int>(RobotShape::kSphere);
  geom.shape = static_cast<RobotShape>(values.oneOf("type", kGeomTypes, fallback));
  if (geom.shape == RobotShape::kMesh) {
    geom.mesh = meshNamed(reading, values);
  } else if (values.element().find("mesh")) {
    values.reject("mesh", "goes with type=\"mesh\": shapes aren't fitted to meshes here.");
  }
  const bool from_to = values.has("fromto");
  readSize(values, geom, from_to);
  geom.X_BG = values.pose(reading.compiler());
  if (from_to) readFromTo(values, geom);
  geom.X_BG = X_BR * geom.X_BG;
  const double unused_friction = readFriction(values, geom);
  geom.contype = values.whole("contype", 1);
  geom.conaffinity = values.whole("conaffinity", 1);
  if (unused_friction > 0 && !geom.isOnlySeen()) reading.frictionless.emplace_back(unused_friction, geom.place);
  geom.priority = values.whole("priority", 0);
  readMass(reading, values, geom);
  return geom;
}

void noteFrictionless(const Reading& reading) {
  const Robot& robot = reading.robot;
  double least = std::numeric_limits<double>::infinity();
  const auto collect = [&](const std::vector<RobotGeom>& geoms) {
    for (const RobotGeom& geom : geoms) {
      if (geom.friction.mu > 0 && !geom.isOnlySeen()) least = std::min(least, geom.friction.mu);
    }
  };
  for (const RobotBody& body : robot.bodies) collect(body.geoms);
  collect(robot.world_geoms);
  for (const auto& [friction, place] : reading.frictionless) {
    if (friction > least)
      reading.document.notes.add("geom friction beside condim 1", "Those that it touches have their own friction.",
                                 place);
  }
}

bool addsMass(const Reading& reading, const Values& values) {
  const int group = values.whole("group", 0);
  return group >= reading.compiler().first_inertia_group && group <= reading.compiler().last_inertia_group;
}

RobotJoint readJoint(Reading& reading, const Values& values, const Pose& X_BR) {
  const Compiler& compiler = reading.compiler();
  RobotJoint joint;
  joint.place = values.element().place();
  joint.name = values.element().find("name") ? values.text("name") : "";
  joint.kind = static_cast<RobotJointKind>(values.oneOf("type", kJointTypes, 0));
  joint.p_B = X_BR * values.vector("pos", Vec3::Zero());
  const Vec3 axis = values.vector("axis", Vec3::UnitZ());
  if (!(axis.norm() > 0)) values.reject("axis", "has no length.");
  joint.axis_B = X_BR.q * axis.normalized();
  const bool turns = joint.kind == RobotJointKind::kHinge || joint.kind == RobotJointKind::kBall;
  const double unit = turns && compiler.degrees ? std::numbers::pi / 180 : 1;
  if (joint.kind != RobotJointKind::kFree) joint.limits = values.limits("range", "limited", compiler.autolimits);
  if (joint.limits) *joint.limits *= unit;
  joint.reference = unit * values.number("ref", 0);
  joint.spring_rest = unit * values.number("springref", 0);
  joint.stiffness = readConstant(values, "stiffness");
  joint.damping = readConstant(values, "damping");
  joint.friction = positiveOrZero(values, "frictionloss");
  joint.armature = positiveOrZero(values, "armature");
  const std::vector<double> spring = values.numbers("springdamper", 2, 2);
  if (!spring.empty()) joint.spring_damper = Vec2(spring[0], spring[1]);
  const bool has_axis = joint.kind == RobotJointKind::kHinge || joint.kind == RobotJointKind::kSlide;
  if (joint.spring_damper.minCoeff() > 0 && !has_axis)
    values.reject("springdamper", "goes with hinges and slides here.");
  joint.drive_forces = values.limits("actuatorfrcrange", "actuatorfrclimited", compiler.autolimits);
  return joint;
}

}  // namespace pincer::tasks::mjcf
