// robot_shapes: a robot's geom as the shape of a scene (docs/scenes.md).
#pragma once
#include "pincer/tasks/run/files/json_writer.h"
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

// Writes the value of "shape"; X_BG is only read for planes, which have it within. Ellipsoids are hulls of 642 points
// on them, meshes their own hulls. Throws InputError at the geom: a mesh without a hull.
void writeRobotShape(const RobotGeom& geom, const Pose& X_BG, const std::vector<RobotMesh>& meshes, JsonWriter& json);

}  // namespace pincer::tasks
