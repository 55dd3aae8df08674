// robot_closure: a pose in which a robot's loops are closed and its couplings hold.
#pragma once
#include <vector>

#include "pincer/tasks/run/robot/robot.h"

namespace pincer::tasks {

// Where a loop holds its two bodies, in their frames.
struct LoopFrames {
  Pose X_AJ, X_BJ;  // of the world where a or b is -1
};
LoopFrames framesOf(const Robot& robot, const RobotLoop& loop);

// Moves hinges and slides, by the least way, until all loops and couplings hold to round-off; those of `held` (by
// coordinates) stay. What holds already isn't touched. Throws InputError at the loop or coupling that stays open.
void closePose(const Robot& robot, const std::vector<bool>& held, std::vector<double>& q);

}  // namespace pincer::tasks
