#include "pincer/tasks/run/robot/robot_shapes.h"

#include <fmt/format.h>

#include "pincer/contact/error.h"
#include "pincer/contact/generated_meshes.h"
#include "pincer/contact/io/printable.h"
#include "pincer/contact/polytope.h"

namespace pincer::tasks {
namespace {

constexpr int kEllipsoidLevel = 3;  // of an icosphere: 642 points

void writePoints(const std::vector<Vec3>& points, JsonWriter& json) {
  json.key("type").value("convex").key("points").beginArray();
  for (const Vec3& p : points) json.value(p);
  json.endArray();
}

std::vector<Vec3> ellipsoidPoints(const Vec3& half) {
  std::vector<Vec3> points = contact::icosphere(1, kEllipsoidLevel).vertices;
  for (Vec3& p : points) p = p.cwiseProduct(half);
  return points;
}

}  // namespace

const std::vector<Vec3>& RobotHulls::cornersOf(const RobotGeom& geom) {
  const auto found = corners_.find(geom.mesh);
  if (found != corners_.end()) return found->second;
  const RobotMesh& mesh = meshes_[static_cast<std::size_t>(geom.mesh)];
  try {
    return corners_[geom.mesh] = contact::Polytope::cornersOfHull(mesh.triangles.vertices, mesh.name);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{}: the mesh \"{}\" has no hull: {}", geom.place, printable(mesh.name), error.what()));
  }
}

void writeRobotShape(const RobotGeom& geom, const Pose& X_BG, RobotHulls& hulls, JsonWriter& json) {
  json.beginObject();
  switch (geom.shape) {
    case RobotShape::kPlane:
      json.key("type").value("half_space").key("normal").value(Vec3(X_BG.q * Vec3::UnitZ())).key("point").value(X_BG.p);
      break;
    case RobotShape::kSphere:
      json.key("type").value("sphere").key("radius").value(geom.half[0]);
      break;
    case RobotShape::kCapsule:
    case RobotShape::kCylinder:
      json.key("type").value(geom.shape == RobotShape::kCapsule ? "capsule" : "cylinder");
      json.key("radius").value(geom.half[0]).key("length").value(2 * geom.half[1]);
      break;
    case RobotShape::kEllipsoid:
      writePoints(ellipsoidPoints(geom.half), json);
      break;
    case RobotShape::kBox:
      json.key("type").value("box").key("size").value(Vec3(2 * geom.half));
      break;
    case RobotShape::kMesh:
      writePoints(hulls.cornersOf(geom), json);
      break;
  }
  json.endObject();
}

}  // namespace pincer::tasks
