// robot_mass: mass, centre of mass and inertia of a robot's geoms, by the rules of MJCF.
#pragma once
#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

// Volume [m^3], of a shell: area [m^2]; 0 for a plane.
double geomVolume(const RobotGeom& geom, const std::vector<RobotMesh>& meshes);

// In the axes of B, of the geom's own mass. `mass` 0 gives zeros. Throws
// InputError at the geom: its mesh has no volume.
engine::MassProperties geomMass(const RobotGeom& geom, const std::vector<RobotMesh>& meshes);

}  // namespace pincer::tasks
