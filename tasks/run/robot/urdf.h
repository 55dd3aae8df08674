// urdf: reads a robot from a URDF file, the format of ROS.
//
// The root link stands still; links become bodies, collisions their shapes, mimic joints couplings. URDF has no drives
// and no friction of surfaces: a scene gives them (docs/robots.md). What has no effect here is counted in the notes
// (effort and velocity limits, what Gazebo and controllers are told); what would change the robot and isn't known here
// is refused by name, file and line (urdf_grammar.h is the list).
#pragma once
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/robot_import.h"

namespace pincer::tasks {

// Files that it names lie in its folder or below, or in one of `allowed_folders`; of package://NAME/PATH the package
// is searched there. Throws InputError: file, line, element, problem, remedy.
RobotImport readUrdf(const std::string& path, const std::vector<std::string>& allowed_folders = {});

}  // namespace pincer::tasks
