// import_report: what came of reading a robot's file: its parts, their masses and places,
// and what of the file has no effect here.
#pragma once
#include <string>

#include "pincer/tasks/run/robot/robot_import.h"

namespace pincer::tasks {

// For people: counts, then one line per kind of thing that has no effect, with how often and where first.
std::string importText(const RobotImport& import);

// For programs: bodies with mass [kg], centre of mass and inertia about it in W [m, kg m^2], pose; joints, drives,
// notes. In the pose that the file draws, and the bodies' poses at each of its keyframes.
std::string importJson(const RobotImport& import);

}  // namespace pincer::tasks
