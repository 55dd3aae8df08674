// worldbody: the tree of bodies with their joints, geoms and sites; and what they weigh.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <set>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/mjcf_parts.h"
#include "pincer/tasks/run/robot/robot_mass.h"

namespace pincer::tasks::mjcf {
namespace {

// Where an element stands: its body, the pose of the innermost frame in the
// body's, and the class of those that name none.
struct Surroundings {
  int body = -1;
  Pose X_BR;
  int class_index = 0;
};

class BodyReader {
 public:
  explicit BodyReader(Reading& reading) : reading_(reading), robot_(reading.robot) {
    for (const XmlElement* section : sections(reading.document, "worldbody")) collectNames(*section);
  }

  void readChildren(const XmlElement& element, const Surroundings& around) {
    for (const XmlElement& child : element.children) readChild(child, around);
  }

 private:
  void collectNames(const XmlElement& element) {
    const std::string* name = element.find("name");
    if (name) given_names_.insert(*name);
    for (const XmlElement& child : element.children) collectNames(child);
  }

  // A name for a part without one: this one, or the first longer one that the file doesn't give to something else.
  std::string unusedName(std::string name) const {
    while (given_names_.count(name)) name += "_";
    return name;
  }

  void readChild(const XmlElement& child, const Surroundings& around) {
    if (child.tag == "body") readBody(child, around);
    if (child.tag == "frame") readFrame(child, around);
    if (child.tag == "joint")
      addJoint(child, around,
               readJoint(reading_, Values(reading_.document, child, "joint", around.class_index), around.X_BR));
    if (child.tag == "freejoint") addJoint(child, around, freeJoint(child));
    if (child.tag == "geom") readGeomOf(child, around);
    if (child.tag == "site") readSite(child, around);
    if (child.tag == "inertial") readInertial(child, around);
  }

  int classWithin(const XmlElement& element, int outer) const {
    const std::string* name = element.find("childclass");
    return name ? classNamed(reading_.document, *name, element) : outer;
  }

  void readBody(const XmlElement& element, const Surroundings& around) {
    const Values values(element);
    const int index = static_cast<int>(robot_.bodies.size());
    RobotBody& body = robot_.bodies.emplace_back();
    body.place = element.place();
    body.name = values.text("name");
    if (body.name.empty()) body.name = unusedName(fmt::format("body{}", index));
    body.parent = around.body;
    body.X_PB = around.X_BR * values.pose(reading_.compiler());
    body.is_driven = values.boolean("mocap", false);
    body.gravity_compensation = values.number("gravcomp", 0);
    if (body.is_driven && around.body >= 0) values.reject("mocap", "goes with bodies of the world only.");
    if (!reading_.bodies.emplace(body.name, index).second)
      element.reject(fmt::format("is the second body called \"{}\".", body.name));
    given_.push_back(false);
    own_.emplace_back();
    readChildren(element, {index, {}, classWithin(element, around.class_index)});
    finishMass(index);
  }

  void readFrame(const XmlElement& element, const Surroundings& around) {
    const Pose X_BR = around.X_BR * Values(element).pose(reading_.compiler());
    readChildren(element, {around.body, X_BR, classWithin(element, around.class_index)});
  }

  RobotJoint freeJoint(const XmlElement& element) const {
    RobotJoint joint;
    joint.kind = RobotJointKind::kFree;
    const Values values(element);
    joint.name = values.text("name");
    joint.place = element.place();
    constexpr std::string_view kWords[] = {"false", "true", "auto"};  // auto: as the compiler's alignfree, off here
    if (values.oneOf("align", kWords, 0) == 1)
      values.reject("align", "isn't known here: frames of free bodies stay as they are drawn.");
    return joint;
  }

  void addJoint(const XmlElement& element, const Surroundings& around, RobotJoint joint) {
    if (around.body < 0) element.reject("stands in the world, which doesn't move.");
    RobotBody& body = robot_.bodies[static_cast<std::size_t>(around.body)];
    const bool joins_a_free_one = !body.joints.empty() && body.joints.front().kind == RobotJointKind::kFree;
    if (joins_a_free_one || (joint.kind == RobotJointKind::kFree && (body.parent >= 0 || !body.joints.empty())))
      element.reject("doesn't go there: a free joint is the only joint of a body of the world.");
    if (joint.kind == RobotJointKind::kBall && joint.limits)
      element.reject("limits a ball joint, which isn't known here. Make it of three hinges, or leave the range out.");
    if (body.is_driven) element.reject("holds a mocap body, which goes where it is told.");
    if (joint.name.empty())
      joint.name = unusedName(body.joints.empty() ? body.name + "_joint"
                                                  : fmt::format("{}_joint{}", body.name, body.joints.size()));
    body.joints.push_back(std::move(joint));
  }

  void readGeomOf(const XmlElement& element, const Surroundings& around) {
    const Values values(reading_.document, element, "geom", around.class_index);
    RobotGeom geom = readGeom(reading_, values, around.X_BR);
    if (!geom.name.empty()) reading_.geom_bodies[geom.name] = around.body;
    if (around.body < 0) {
      robot_.world_geoms.push_back(std::move(geom));
      return;
    }
    if (addsMass(reading_, values)) own_[static_cast<std::size_t>(around.body)].push_back(geom);
    robot_.bodies[static_cast<std::size_t>(around.body)].geoms.push_back(std::move(geom));
  }

  void readSite(const XmlElement& element, const Surroundings& around) {
    const Values values(reading_.document, element, "site", around.class_index);
    const Pose X_RS = values.has("fromto") ? readEnds(values).X : values.pose(reading_.compiler());
    const std::string name = element.find("name") ? values.text("name") : "";
    if (!name.empty()) robot_.frames.push_back({name, around.body, around.X_BR * X_RS});
  }

  void readInertial(const XmlElement& element, const Surroundings& around) {
    if (around.body < 0) element.reject("stands in the world, which has no mass.");
    if (reading_.compiler().inertia_from_geoms == InertiaFromGeoms::kAlways) return;
    const Values values(element);
    engine::MassProperties& inertia = robot_.bodies[static_cast<std::size_t>(around.body)].inertia;
    inertia.mass = values.number("mass", -1);
    if (!(inertia.mass >= 0)) element.reject("needs a mass of 0 or more.");
    if (!values.has("pos")) element.reject("needs the attribute \"pos\".");
    inertia.p_BBcm = around.X_BR * values.vector("pos", Vec3::Zero());
    const Mat3 R = (around.X_BR.q * values.orientation(reading_.compiler())).toRotationMatrix();
    inertia.I_BBcm = R * readTensor(values) * R.transpose();
    given_[static_cast<std::size_t>(around.body)] = true;
  }

  static Mat3 readTensor(const Values& values) {
    const std::vector<double> full = values.numbers("fullinertia", 6, 6);
    if (full.empty()) return Mat3(values.vector("diaginertia", Vec3::Zero()).asDiagonal());
    if (values.has("diaginertia")) values.element().reject("has its inertia twice. Keep diaginertia or fullinertia.");
    Mat3 I;
    I << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
    return I;
  }

  // Where inertial says nothing, the sum of the geoms'.
  void finishMass(int index) {
    RobotBody& body = robot_.bodies[static_cast<std::size_t>(index)];
    if (!given_[static_cast<std::size_t>(index)] &&
        reading_.compiler().inertia_from_geoms != InertiaFromGeoms::kNever) {
      std::vector<engine::MassProperties> parts;
      for (const RobotGeom& geom : own_[static_cast<std::size_t>(index)]) {
        if (geom.mass > 0) parts.push_back(geomMass(geom, robot_.meshes));
      }
      if (!parts.empty()) body.inertia = engine::sumOf(parts);
    }
    const Compiler& compiler = reading_.compiler();
    body.inertia.mass = std::max(body.inertia.mass, compiler.least_mass);
    if (compiler.least_inertia > 0) raiseMoments(body.inertia.I_BBcm, compiler.least_inertia);
    if (compiler.balance_inertia) balanceMoments(body.inertia.I_BBcm);
  }

  // No body has a principal moment above the sum of the others: such a one gets the mean of all three about every axis.
  static void balanceMoments(Mat3& I) {
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(I).eigenvalues();
    if (moments[0] + moments[1] < moments[2]) I = I.trace() / 3 * Mat3::Identity();
  }

  static void raiseMoments(Mat3& I, double least) {
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(I);
    const Vec3 moments = principal.eigenvalues().cwiseMax(least);
    I = principal.eigenvectors() * moments.asDiagonal() * principal.eigenvectors().transpose();
  }

  Reading& reading_;
  Robot& robot_;
  std::vector<bool> given_;                  // by body: inertial stands there
  std::vector<std::vector<RobotGeom>> own_;  // by body: geoms that add mass
  std::set<std::string> given_names_;        // of all that has one in the world
};

void scaleMasses(Robot& robot, double wanted) {
  double sum = 0;
  for (const RobotBody& body : robot.bodies) sum += body.inertia.mass;
  if (!(wanted > 0 && sum > 0)) return;
  for (RobotBody& body : robot.bodies) {
    body.inertia.mass *= wanted / sum;
    body.inertia.I_BBcm *= wanted / sum;
  }
}

// Its own mass, that of all that hangs on it, and armatures: something that its joints move.
void requireSomethingToMove(const Robot& robot) {
  std::vector<double> inertias;
  for (const RobotBody& body : robot.bodies) {
    double& sum = inertias.emplace_back(body.inertia.mass);
    for (const RobotJoint& joint : body.joints) sum += joint.armature;
  }
  for (std::size_t i = robot.bodies.size(); i-- > 0;) {  // parents come first
    const RobotBody& body = robot.bodies[i];
    if (!body.joints.empty() && !(inertias[i] > 0))
      throw InputError(printableMessage(
          fmt::format("{}: joint \"{}\" moves no mass: neither body \"{}\" nor what hangs on it has any. Give a geom a "
                      "mass, or the joint an armature.",
                      body.joints.front().place, body.joints.front().name, body.name)));
    if (body.parent >= 0) inertias[static_cast<std::size_t>(body.parent)] += inertias[i];
  }
}

void refuseMovingPlanes(const Robot& robot) {
  std::vector<bool> moves;
  for (const RobotBody& body : robot.bodies) {
    moves.push_back(!body.joints.empty() || (body.parent >= 0 && moves[static_cast<std::size_t>(body.parent)]));
    if (!moves.back()) continue;
    for (const RobotGeom& geom : body.geoms) {
      if (geom.shape == RobotShape::kPlane)
        throw InputError(printableMessage(
            fmt::format("{}: <geom> is a plane on body \"{}\", which moves. Planes stand still: make it a box.",
                        geom.place, body.name)));
    }
  }
}

void nameJoints(Reading& reading) {
  int coordinates = 0;
  for (const RobotBody& body : reading.robot.bodies) {
    reading.coordinates.push_back(coordinates);
    for (const RobotJoint& joint : body.joints) {
      coordinates += joint.kind == RobotJointKind::kFree ? 7 : joint.kind == RobotJointKind::kBall ? 4 : 1;
      if (!reading.joints.emplace(joint.name, &joint).second)
        throw InputError(
            printableMessage(fmt::format("{}: <joint> is the second joint called \"{}\".", joint.place, joint.name)));
    }
  }
  reading.coordinates.push_back(coordinates);
}

}  // namespace

void readBodies(Reading& reading) {
  BodyReader reader(reading);
  for (const XmlElement* section : sections(reading.document, "worldbody")) {
    const std::string* name = section->find("childclass");
    reader.readChildren(*section, {-1, {}, name ? classNamed(reading.document, *name, *section) : 0});
  }
  requireSomethingToMove(reading.robot);
  refuseMovingPlanes(reading.robot);
  scaleMasses(reading.robot, reading.compiler().total_mass);
  tuneSprings(reading.robot);
  nameJoints(reading);
}

int bodyNamed(const Reading& reading, const Values& values, std::string_view attribute) {
  const std::string name = values.required(attribute);
  if (name == "world") return -1;
  if (const auto at = reading.bodies.find(name); at != reading.bodies.end()) return at->second;
  std::vector<std::string_view> names;
  for (const auto& [known, index] : reading.bodies) names.push_back(known);
  values.reject(attribute, fmt::format("is the name of no body.{}", suggestion(name, names)));
}

const RobotJoint& jointNamed(const Reading& reading, const Values& values, std::string_view attribute) {
  const std::string name = values.required(attribute);
  if (const auto at = reading.joints.find(name); at != reading.joints.end()) return *at->second;
  std::vector<std::string_view> names;
  for (const auto& [known, joint] : reading.joints) names.push_back(known);
  values.reject(attribute, fmt::format("is the name of no joint.{}", suggestion(name, names)));
}

}  // namespace pincer::tasks::mjcf
