#include "pincer/tasks/run/robot/robot_links.h"

#include <fmt/format.h>

#include <algorithm>

#include "pincer/contact/error.h"
#include "pincer/tasks/run/files/spelling.h"
#include "pincer/tasks/run/robot/robot_closure.h"
#include "pincer/tasks/run/robot/robot_pose.h"

namespace pincer::tasks {
namespace {

const RobotKeyframe* keyframeNamed(const Robot& robot, const std::string& name) {
  if (name.empty()) return nullptr;
  std::vector<std::string_view> names;
  for (const RobotKeyframe& key : robot.keyframes) {
    if (key.name == name) return &key;
    names.push_back(key.name);
  }
  throw InputError(fmt::format("{}: has no keyframe \"{}\".{}", robot.file, name, suggestion(name, names)));
}

bool moves(const RobotBody& body) { return !body.joints.empty() || body.is_driven; }

void addInertia(const engine::MassProperties& inertia, const Pose& X_LB, RobotLink& link) {
  if (inertia.mass == 0) return;
  const engine::MassProperties moved = engine::movedBy(X_LB, inertia);
  const engine::MassProperties parts[] = {link.inertia, moved};
  link.inertia = link.inertia.mass == 0 ? moved : engine::sumOf(parts);
}

bool isNamedApart(const Robot& robot, int body) {
  return std::any_of(robot.excluded.begin(), robot.excluded.end(),
                     [&](const RobotExclusion& e) { return e.a == body || e.b == body; });
}

// Parts that stand still cost nothing: those that are kept apart from something are bodies of
// their own, and so is what is fixed to them.
bool isPartApart(const PosedRobot& posed, int index) {
  const int parent = posed.body(index).parent;
  if (!posed.links[static_cast<std::size_t>(posed.link_of[static_cast<std::size_t>(parent)])].is_static) return false;
  return isNamedApart(posed.robot, index) || isNamedApart(posed.robot, parent);
}

void gatherLinks(PosedRobot& posed) {
  for (int i = 0; i < static_cast<int>(posed.robot.bodies.size()); ++i) {
    const RobotBody& body = posed.body(i);
    const bool is_own = body.parent < 0 || moves(body) || isPartApart(posed, i);
    if (is_own) posed.links.push_back({i, !moves(body), {}, {}});
    posed.link_of.push_back(is_own ? static_cast<int>(posed.links.size()) - 1
                                   : posed.link_of[static_cast<std::size_t>(body.parent)]);
    RobotLink& link = posed.links[static_cast<std::size_t>(posed.link_of.back())];
    const Pose X_LB = is_own ? Pose{} : posed.pose(link.body).inverse() * posed.pose(i);
    for (const RobotGeom& geom : body.geoms) link.geoms.emplace_back(&geom, is_own ? geom.X_BG : X_LB * geom.X_BG);
    addInertia(body.inertia, X_LB, link);
  }
}

std::size_t coordinateNamed(const Robot& robot, const std::string& name) {
  std::vector<std::string_view> names;
  int at = 0;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      const int count = coordinateCount(joint.kind);
      if (count == 1 && joint.name == name) return static_cast<std::size_t>(at);
      if (count == 1) names.push_back(joint.name);
      at += count;
    }
  }
  throw InputError(fmt::format("{}: has no hinge or slide \"{}\".{}", robot.file, name, suggestion(name, names)));
}

// Contact with a stop begins at the stop: there is no way to start beyond it.
void holdWithinLimits(const Robot& robot, std::vector<double>& q, ImportNotes& notes) {
  double* at = q.data();
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      if (joint.limits && (*at < (*joint.limits)[0] || *at > (*joint.limits)[1])) {
        *at = std::clamp(*at, (*joint.limits)[0], (*joint.limits)[1]);
        notes.add("start beyond a limit", "The joint starts at its stop.", joint.place);
      }
      at += coordinateCount(joint.kind);
    }
  }
}

}  // namespace

const double* PosedRobot::coordinatesOf(int body_index) const {
  const double* at = q.data();
  for (int i = 0; i < body_index; ++i) {
    for (const RobotJoint& joint : body(i).joints) at += coordinateCount(joint.kind);
  }
  return at;
}

Pose PosedRobot::poseAfter(int body_index, std::size_t joints) const {
  const Pose X_PB = poseInParent(body(body_index), coordinatesOf(body_index), joints);
  return body(body_index).parent < 0 ? X_WR * X_PB : pose(body(body_index).parent) * X_PB;
}

PosedRobot poseRobot(const Robot& robot, const RobotSceneOptions& options, ImportNotes& notes) {
  PosedRobot posed{robot, options.X_WR, keyframeNamed(robot, options.keyframe), {}, {}, {}, {}};
  posed.q = posed.key && !posed.key->q.empty() ? posed.key->q : drawnCoordinates(robot);
  std::vector<bool> held(posed.q.size(), false);
  for (const auto& [joint, value] : options.start) {
    const std::size_t at = coordinateNamed(robot, joint);
    posed.q[at] = value;
    held[at] = true;
  }
  holdWithinLimits(robot, posed.q, notes);
  closePose(robot, held, posed.q);
  for (const Pose& X_RB : bodyPoses(robot, posed.q)) posed.poses.push_back(options.X_WR * X_RB);
  gatherLinks(posed);
  return posed;
}

}  // namespace pincer::tasks
