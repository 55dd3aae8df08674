// robot_pose: where a robot's bodies are for given coordinates of its joints, and
// what a joint feels of the mass beyond it.
//
// Coordinates are those of a keyframe, in the order of bodies and their joints: hinge and slide one number each, a ball
// four (w, x, y, z), a free joint seven (place in W, then the quaternion).
#pragma once
#include <vector>

#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

int coordinateCount(RobotJointKind kind);

// Coordinates of the pose that the file draws: hinges and slides at their references, balls
// unturned, free bodies where they are drawn.
std::vector<double> drawnCoordinates(const Robot& robot);

// X_WB of every body. `q` has as many numbers as drawnCoordinates.
std::vector<Pose> bodyPoses(const Robot& robot, const std::vector<double>& q);

// How a body's frame moves, past its parent's, when its first `joints` joints have moved: X_PB at those coordinates.
Pose poseInParent(const RobotBody& body, const double* q, std::size_t joints);

// The inertia that each joint's own coordinate feels in these poses: of all that hangs on it, and its armature [kg m^2,
// kg]. By bodies and joints; of balls and free joints 0.
std::vector<double> ownInertias(const Robot& robot, const std::vector<Pose>& poses);

}  // namespace pincer::tasks
