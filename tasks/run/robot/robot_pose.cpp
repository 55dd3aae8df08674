#include "pincer/tasks/run/robot/robot_pose.h"

#include "pincer/contact/elementary.h"

namespace pincer::tasks {
namespace {

Quat turnAbout(const Vec3& axis, double angle) {
  const Vec3 v = math::sin(0.5 * angle) * axis;
  return {math::cos(0.5 * angle), v[0], v[1], v[2]};
}

Quat quatAt(const double* q) { return Quat(q[0], q[1], q[2], q[3]).normalized(); }

// The turn that a joint has made, about its own place.
Pose turnedAt(const Vec3& p, const Quat& turn) { return {turn, p - turn * p}; }

// Past the pose before it; joints of one body move it one after the other, each in
// the frame that the ones before have moved.
Pose jointMotion(const RobotJoint& joint, const double* q) {
  switch (joint.kind) {
    case RobotJointKind::kHinge:
      return turnedAt(joint.p_B, turnAbout(joint.axis_B, *q - joint.reference));
    case RobotJointKind::kSlide:
      return {Quat::Identity(), (*q - joint.reference) * joint.axis_B};
    case RobotJointKind::kBall:
      return turnedAt(joint.p_B, quatAt(q));
    case RobotJointKind::kFree:
      return {quatAt(q + 3), Vec3(q[0], q[1], q[2])};
  }
  return {};
}

// Of a body about the line through `p` along `axis`, all in W.
double momentAbout(const RobotBody& body, const Pose& X_WB, const Vec3& p_W, const Vec3& axis_W) {
  const Vec3 axis_B = X_WB.q.conjugate() * axis_W;
  const Vec3 arm = X_WB * body.inertia.p_BBcm - p_W;
  return axis_B.dot(body.inertia.I_BBcm * axis_B) + body.inertia.mass * arm.cross(axis_W).squaredNorm();
}

bool hangsOn(const Robot& robot, int body, int ancestor) {
  while (body > ancestor) body = robot.bodies[static_cast<std::size_t>(body)].parent;
  return body == ancestor;
}

double ownInertia(const Robot& robot, const std::vector<Pose>& poses, int body, const RobotJoint& joint) {
  const Pose& X_WB = poses[static_cast<std::size_t>(body)];
  double sum = joint.armature;
  for (int i = body; i < static_cast<int>(robot.bodies.size()); ++i) {
    if (!hangsOn(robot, i, body)) continue;
    const RobotBody& beyond = robot.bodies[static_cast<std::size_t>(i)];
    sum += joint.kind == RobotJointKind::kSlide
               ? beyond.inertia.mass
               : momentAbout(beyond, poses[static_cast<std::size_t>(i)], X_WB * joint.p_B, X_WB.q * joint.axis_B);
  }
  return sum;
}

}  // namespace

int coordinateCount(RobotJointKind kind) {
  return kind == RobotJointKind::kFree ? 7 : kind == RobotJointKind::kBall ? 4 : 1;
}

std::vector<double> drawnCoordinates(const Robot& robot) {
  std::vector<double> q;
  for (const RobotBody& body : robot.bodies) {
    for (const RobotJoint& joint : body.joints) {
      const Quat& turn = body.X_PB.q;
      if (joint.kind == RobotJointKind::kFree) q.insert(q.end(), {body.X_PB.p[0], body.X_PB.p[1], body.X_PB.p[2]});
      if (joint.kind == RobotJointKind::kFree) q.insert(q.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
      if (joint.kind == RobotJointKind::kBall) q.insert(q.end(), {1, 0, 0, 0});
      if (coordinateCount(joint.kind) == 1) q.push_back(joint.reference);
    }
  }
  return q;
}

Pose poseInParent(const RobotBody& body, const double* q, std::size_t joints) {
  Pose X_PB = body.X_PB;
  for (std::size_t i = 0; i < joints; ++i) {
    const RobotJoint& joint = body.joints[i];
    X_PB = joint.kind == RobotJointKind::kFree ? jointMotion(joint, q) : X_PB * jointMotion(joint, q);
    q += coordinateCount(joint.kind);
  }
  return X_PB;
}

std::vector<Pose> bodyPoses(const Robot& robot, const std::vector<double>& q) {
  std::vector<Pose> poses;
  const double* at = q.data();
  for (const RobotBody& body : robot.bodies) {
    const Pose X_PB = poseInParent(body, at, body.joints.size());
    poses.push_back(body.parent < 0 ? X_PB : poses[static_cast<std::size_t>(body.parent)] * X_PB);
    for (const RobotJoint& joint : body.joints) at += coordinateCount(joint.kind);
  }
  return poses;
}

std::vector<double> ownInertias(const Robot& robot, const std::vector<Pose>& poses) {
  std::vector<double> inertias;
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    for (const RobotJoint& joint : robot.bodies[i].joints)
      inertias.push_back(coordinateCount(joint.kind) == 1 ? ownInertia(robot, poses, static_cast<int>(i), joint) : 0);
  }
  return inertias;
}

}  // namespace pincer::tasks
