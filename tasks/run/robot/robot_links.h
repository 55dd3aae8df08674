// robot_links: a robot in a pose, and its bodies gathered into links: parts that move as one.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "pincer/tasks/run/robot/import_notes.h"
#include "pincer/tasks/run/robot/robot.h"
#include "pincer/tasks/run/robot/robot_scene.h"

namespace pincer::tasks {

// A body with joints, or one of the world, and the bodies that are fixed to it. Of what stands
// still an excluded part is a link of its own.
struct RobotLink {
  int body = 0;            // whose frame is the link's
  bool is_static = false;  // it hangs on nothing: it stands still
  engine::MassProperties inertia;
  std::vector<std::pair<const RobotGeom*, Pose>> geoms;  // and their poses
};

struct PosedRobot {
  const Robot& robot;
  Pose X_WR;                           // where the file's world stands
  const RobotKeyframe* key = nullptr;  // null: as drawn
  std::vector<double> q;               // coordinates, see robot_pose.h
  std::vector<Pose> poses;             // X_WB, by body
  std::vector<RobotLink> links;
  std::vector<int> link_of;  // by body

  const RobotBody& body(int index) const { return robot.bodies[static_cast<std::size_t>(index)]; }
  const Pose& pose(int index) const { return poses[static_cast<std::size_t>(index)]; }
  // The body whose frame is that of the link to which this one belongs.
  int carrier(int index) const {
    return links[static_cast<std::size_t>(link_of[static_cast<std::size_t>(index)])].body;
  }
  const double* coordinatesOf(int body_index) const;  // the first one of its joints
  // X_WB of a body when only its first `joints` joints have moved.
  Pose poseAfter(int body_index, std::size_t joints) const;
};

// Where the options have it start. Joints that would be beyond a stop are at it, which is noted; loops and couplings
// are closed then (robot_closure.h). Throws InputError: there is no such keyframe, no such joint, or one without a
// coordinate of its own; a loop stays open.
PosedRobot poseRobot(const Robot& robot, const RobotSceneOptions& options, ImportNotes& notes);

}  // namespace pincer::tasks
