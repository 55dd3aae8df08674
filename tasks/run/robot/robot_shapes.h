// robot_shapes: a robot's geom as the shape of a scene (docs/scenes.md).
#pragma once
#include <map>
#include <vector>

#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

// The corners of the hulls of a robot's meshes, each found once however many geoms show it.
class RobotHulls {
 public:
  explicit RobotHulls(const std::vector<RobotMesh>& meshes) : meshes_(meshes) {}
  // Of the geom's mesh. Throws InputError at the geom: a mesh without a hull.
  const std::vector<Vec3>& cornersOf(const RobotGeom& geom);

 private:
  const std::vector<RobotMesh>& meshes_;
  std::map<int, std::vector<Vec3>> corners_;  // by mesh
};

// Writes the value of "shape"; X_BG is only read for planes, which have it within. Ellipsoids are hulls of 642 points
// on them, meshes their own hulls. Throws InputError at the geom: a mesh without a hull.
void writeRobotShape(const RobotGeom& geom, const Pose& X_BG, RobotHulls& hulls, JsonWriter& json);

}  // namespace pincer::tasks
