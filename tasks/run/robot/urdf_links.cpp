// link: mass, collision shapes, meshes.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <filesystem>
#include <numbers>

#include "pincer/tasks/run/robot/model_mesh.h"
#include "pincer/tasks/run/robot/urdf_parts.h"

namespace pincer::tasks::urdf {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;  // [rad]
constexpr double kMomentRoundOff = 1e-9;            // of the largest moment: files have some ten digits
constexpr double kShortest = 1e-14;                 // of a quaternion that can be made one of length 1

double positive(const XmlValues& values, std::string_view name) {
  const double value = values.requiredNumber(name);
  if (!(value > 0)) values.reject(name, "isn't positive. Sizes are, in metres.");
  return value;
}

// R = R_z(yaw) R_y(pitch) R_x(roll): about axes that stand still.
Quat quatOfRpy(const Vec3& rpy) {
  return quatOfAxisAngle(Vec3::UnitZ(), rpy[2]) *
         (quatOfAxisAngle(Vec3::UnitY(), rpy[1]) * quatOfAxisAngle(Vec3::UnitX(), rpy[0]));
}

Quat quatOfXyzw(const XmlValues& values) {
  const std::vector<double> v = values.numbers("quat_xyzw", 4, 4);
  const Quat q(v[3], v[0], v[1], v[2]);
  if (!(q.norm() > kShortest)) values.reject("quat_xyzw", "has no length. No turn is 0 0 0 1.");
  if (values.has("rpy")) values.reject("rpy", "is a second way to say the turn. Keep rpy or quat_xyzw.");
  return q.normalized();
}

// Moments of masses: none negative, and none above the sum of the other two.
void requireInertia(const XmlValues& values, const Mat3& I) {
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(I).eigenvalues();
  const double slack = kMomentRoundOff * std::abs(moments[2]);
  if (moments[0] < -slack || moments[0] + moments[1] < moments[2] - slack) {
    values.element().reject(fmt::format(
        "is no body's: its principal moments {:.6g}, {:.6g} and {:.6g} kg m^2 must not be negative, nor one "
        "above the sum of the others. Export it anew, or take it from the link's shape.",
        moments[0], moments[1], moments[2]));
  }
}

Mat3 readTensor(const XmlElement& element) {
  const XmlValues values(element);
  const double xx = values.requiredNumber("ixx"), yy = values.requiredNumber("iyy"), zz = values.requiredNumber("izz");
  const double xy = values.number("ixy", 0), xz = values.number("ixz", 0), yz = values.number("iyz", 0);
  Mat3 I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  requireInertia(values, I);
  return I;
}

}  // namespace

const XmlElement* onlyChild(const XmlElement& element, std::string_view tag) {
  const XmlElement* found = nullptr;
  for (const XmlElement& child : element.children) {
    if (child.tag != tag) continue;
    if (found) child.reject(fmt::format("is the second one of this <{}>. Keep one of them.", element.tag));
    found = &child;
  }
  return found;
}

Pose LinkReader::readOrigin(const XmlElement& element) {
  const XmlElement* origin = onlyChild(element, "origin");
  if (!origin) return {};
  const XmlValues values(*origin);
  const Vec3 rpy = values.vector("rpy", Vec3::Zero());
  if (rpy.cwiseAbs().maxCoeff() > kFullTurn)
    notes_.add("origin rpy above a turn", "It is read as radians, as URDF has it.", origin->place());
  return {values.has("quat_xyzw") ? quatOfXyzw(values) : quatOfRpy(rpy), values.vector("xyz", Vec3::Zero())};
}

engine::MassProperties LinkReader::readInertial(const XmlElement& element) {
  const XmlElement *mass = onlyChild(element, "mass"), *tensor = onlyChild(element, "inertia");
  if (!mass) element.reject("needs a <mass>.");
  const XmlValues values(*mass);
  engine::MassProperties inertia;
  inertia.mass = values.requiredNumber("value");
  if (!(inertia.mass >= 0)) values.reject("value", "is negative. Masses are in kg, 0 or more.");
  if (!tensor) element.reject("needs an <inertia>.");
  const Pose X_BI = readOrigin(element);
  const Mat3 R = X_BI.q.toRotationMatrix();
  inertia.p_BBcm = X_BI.p;
  inertia.I_BBcm = R * readTensor(*tensor) * R.transpose();
  return inertia;
}

int LinkReader::meshOf(const XmlElement& element) {
  const XmlValues values(element);
  const std::string uri = values.required("filename");
  const std::vector<double> given = values.numbers("scale", 1, 3);
  if (given.size() == 2) values.reject("scale", "has two numbers. One is for all axes, three are for each.");
  Vec3 scale = Vec3::Ones();
  for (Eigen::Index k = 0; k < 3 && !given.empty(); ++k) scale[k] = given[given.size() == 1 ? 0 : std::size_t(k)];
  if (!(scale.cwiseAbs().minCoeff() > 0)) values.reject("scale", "flattens the mesh: no factor may be 0.");
  const std::string path = folder_.findUri(element, uri);
  const auto [at, is_new] = meshes_.try_emplace({path, scale[0], scale[1], scale[2]}, int(robot_.meshes.size()));
  if (is_new) {
    RobotMesh mesh;
    mesh.place = element.place();
    mesh.name = std::filesystem::path(path).stem().string();
    mesh.file = path;
    mesh.triangles = readModelMesh(element, path);
    mesh.triangles.source = path;
    scaleMesh(scale, mesh.triangles);
    robot_.meshes.push_back(std::move(mesh));
  }
  return at->second;
}

void LinkReader::readShape(const XmlElement& element, RobotGeom& geom) {
  const XmlValues values(element);
  if (element.tag == "box") {
    values.required("size");
    geom.shape = RobotShape::kBox;
    geom.half = 0.5 * values.vector("size", Vec3::Zero());
    if (!(geom.half.minCoeff() > 0)) values.reject("size", "isn't positive along each axis. Sizes are, in metres.");
  } else if (element.tag == "sphere") {
    geom.shape = RobotShape::kSphere;
    geom.half[0] = positive(values, "radius");
  } else if (element.tag == "mesh") {
    geom.shape = RobotShape::kMesh;
    geom.mesh = meshOf(element);
  } else {
    geom.shape = element.tag == "capsule" ? RobotShape::kCapsule : RobotShape::kCylinder;
    geom.half[0] = positive(values, "radius");
    geom.half[1] = 0.5 * positive(values, "length");
  }
}

RobotGeom LinkReader::readCollision(const XmlElement& element) {
  RobotGeom geom;
  geom.place = element.place();
  geom.name = XmlValues(element).text("name");
  geom.X_BG = readOrigin(element);
  const XmlElement* geometry = onlyChild(element, "geometry");
  if (!geometry) element.reject("needs a <geometry>.");
  if (geometry->children.size() != 1)
    geometry->reject(
        fmt::format("holds {} shapes. A collision has one; give the link further ones.", geometry->children.size()));
  readShape(geometry->children[0], geom);
  return geom;
}

RobotBody LinkReader::readLink(const XmlElement& element) {
  RobotBody body;
  body.place = element.place();
  body.name = XmlValues(element).required("name");
  if (const XmlElement* inertial = onlyChild(element, "inertial")) body.inertia = readInertial(*inertial);
  bool is_seen = false;
  for (const XmlElement& child : element.children) {
    is_seen = is_seen || child.tag == "visual";
    if (child.tag == "collision") body.geoms.push_back(readCollision(child));
  }
  if (is_seen && body.geoms.empty())
    notes_.add("link visual without collision", "Nothing touches the link.", element.place());
  return body;
}

}  // namespace pincer::tasks::urdf
