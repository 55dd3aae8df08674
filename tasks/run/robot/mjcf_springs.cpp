// Springs that are given by how fast they are: with the inertia m that a joint's coordinate feels while all other
// joints are free to move, T its time constant and z its damping ratio, the stiffness is m/(T z)^2 and the damping
// 2 m/T.
//
//   1/m_j = (M^-1)_jj,   M = sum over bodies of m J_v^T J_v + J_w^T I J_w, and armatures
#include <Eigen/Cholesky>
#include <algorithm>

#include "pincer/tasks/run/robot/mjcf_parts.h"
#include "pincer/tasks/run/robot/robot_pose.h"

namespace pincer::tasks::mjcf {
namespace {

// A direction in which a joint moves all that hangs on its body.
struct Freedom {
  int body;
  bool turns;
  Vec3 point_W, axis_W;
  double armature;
};

std::vector<Freedom> freedomsOf(const RobotJoint& joint, int body, const Pose& X_WB) {
  const Vec3 point = X_WB * joint.p_B;
  if (joint.kind == RobotJointKind::kHinge || joint.kind == RobotJointKind::kSlide)
    return {{body, joint.kind == RobotJointKind::kHinge, point, X_WB.q * joint.axis_B, joint.armature}};
  std::vector<Freedom> all;
  for (int k = 0; k < 3; ++k) {
    if (joint.kind == RobotJointKind::kFree) all.push_back({body, false, point, Vec3::Unit(k), joint.armature});
    all.push_back({body, true, point, X_WB.q * Vec3::Unit(k), joint.armature});
  }
  return all;
}

class MassMatrix {
 public:
  explicit MassMatrix(const Robot& robot) : robot_(robot), poses_(bodyPoses(robot, drawnCoordinates(robot))) {
    for (int i = 0; i < static_cast<int>(robot.bodies.size()); ++i) {
      for (const RobotJoint& joint : robot.bodies[static_cast<std::size_t>(i)].joints) {
        first_.push_back(freedoms_.size());
        const auto of_joint = freedomsOf(joint, i, poses_[static_cast<std::size_t>(i)]);
        freedoms_.insert(freedoms_.end(), of_joint.begin(), of_joint.end());
      }
    }
  }

  // By joints: what its first freedom feels; 0 where nothing resists.
  std::vector<double> feltInertias() const {
    const auto n = static_cast<Eigen::Index>(freedoms_.size());
    const Eigen::MatrixXd inverse = matrix().ldlt().solve(Eigen::MatrixXd::Identity(n, n));
    std::vector<double> felt;
    for (const std::size_t first : first_) {
      const double m = 1 / inverse(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(first));
      felt.push_back(m > 0 ? m : 0);
    }
    return felt;
  }

 private:
  bool carries(int body, int other) const {
    while (other > body) other = robot_.bodies[static_cast<std::size_t>(other)].parent;
    return other == body;
  }

  Eigen::MatrixXd matrix() const {
    const auto n = static_cast<Eigen::Index>(freedoms_.size());
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index j = 0; j < n; ++j) M(j, j) = freedoms_[static_cast<std::size_t>(j)].armature;
    for (std::size_t b = 0; b < robot_.bodies.size(); ++b) {
      const engine::MassProperties& inertia = robot_.bodies[b].inertia;
      const Vec3 center = poses_[b] * inertia.p_BBcm;
      const Mat3 R = poses_[b].q.toRotationMatrix();
      Eigen::Matrix3Xd J_v = Eigen::Matrix3Xd::Zero(3, n), J_w = J_v;
      for (Eigen::Index j = 0; j < n; ++j) {
        const Freedom& f = freedoms_[static_cast<std::size_t>(j)];
        if (!carries(f.body, static_cast<int>(b))) continue;
        if (f.turns) J_w.col(j) = f.axis_W;
        J_v.col(j) = f.turns ? Vec3(f.axis_W.cross(center - f.point_W)) : f.axis_W;
      }
      M += inertia.mass * J_v.transpose() * J_v + J_w.transpose() * (R * inertia.I_BBcm * R.transpose()) * J_w;
    }
    return M;
  }

  const Robot& robot_;
  std::vector<Pose> poses_;
  std::vector<Freedom> freedoms_;
  std::vector<std::size_t> first_;  // by joints
};

bool isTuned(const RobotJoint& joint) { return joint.spring_damper.minCoeff() > 0; }

bool hasTuned(const Robot& robot) {
  return std::any_of(robot.bodies.begin(), robot.bodies.end(), [](const RobotBody& body) {
    return std::any_of(body.joints.begin(), body.joints.end(), isTuned);
  });
}

}  // namespace

void tuneSprings(Robot& robot) {
  if (!hasTuned(robot)) return;
  const std::vector<double> felt = MassMatrix(robot).feltInertias();
  auto inertia = felt.begin();
  for (RobotBody& body : robot.bodies) {
    for (RobotJoint& joint : body.joints) {
      const double m = *inertia++, time = joint.spring_damper[0], ratio = joint.spring_damper[1];
      if (!isTuned(joint)) continue;
      joint.stiffness = m / (time * time * ratio * ratio);
      joint.damping = 2 * m / time;
    }
  }
}

}  // namespace pincer::tasks::mjcf
