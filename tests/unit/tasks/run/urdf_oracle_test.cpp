// URDF as ROS's own reader has it (Debian's liburdfdom-dev), where that is: masses, inertias and places of links.
// PINCER_URDF may name a further file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "pincer/tasks/run/robot/robot_pose.h"
#include "pincer/tasks/run/robot/urdf.h"

#if __has_include(<urdf_parser/urdf_parser.h>)
#include <urdf_parser/urdf_parser.h>
#define PINCER_HAS_URDFDOM 1
#else
#define PINCER_HAS_URDFDOM 0
#endif

namespace pincer::tasks {
namespace {

constexpr double kAlongChains = 1e-12;  // of metres, kilograms and kg m^2, along chains of ten links

#if PINCER_HAS_URDFDOM

Pose poseOf(const urdf::Pose& X) {
  return {Quat(X.rotation.w, X.rotation.x, X.rotation.y, X.rotation.z), {X.position.x, X.position.y, X.position.z}};
}

Pose placeOf(const urdf::Link& link) {
  const auto parent = link.getParent();
  return parent ? placeOf(*parent) * poseOf(link.parent_joint->parent_to_joint_origin_transform) : Pose{};
}

void compareMass(const urdf::Link& theirs, const engine::MassProperties& ours) {
  EXPECT_EQ(ours.mass, theirs.inertial ? theirs.inertial->mass : 0);
  if (!theirs.inertial) return;
  const urdf::Inertial& m = *theirs.inertial;
  const Pose X_BI = poseOf(m.origin);
  const Mat3 R = X_BI.q.toRotationMatrix();
  Mat3 I;
  I << m.ixx, m.ixy, m.ixz, m.ixy, m.iyy, m.iyz, m.ixz, m.iyz, m.izz;
  EXPECT_LT((ours.p_BBcm - X_BI.p).norm(), kAlongChains);
  EXPECT_LT((ours.I_BBcm - R * I * R.transpose()).norm(), kAlongChains);
}

void compareJoint(const urdf::Joint& theirs, const RobotJoint& ours) {
  EXPECT_EQ(ours.name, theirs.name);
  EXPECT_LT((ours.axis_B - Vec3(theirs.axis.x, theirs.axis.y, theirs.axis.z).normalized()).norm(), kAlongChains);
  if (ours.limits) {
    EXPECT_EQ(*ours.limits, Vec2(theirs.limits->lower, theirs.limits->upper));
  }
  EXPECT_EQ(ours.damping, theirs.dynamics ? theirs.dynamics->damping : 0);
  EXPECT_EQ(ours.friction, theirs.dynamics ? theirs.dynamics->friction : 0);
}

void compare(const std::string& file) {
  SCOPED_TRACE(file);
  const auto theirs = urdf::parseURDFFile(file);
  ASSERT_TRUE(theirs);
  const Robot ours = readUrdf(file).robot;
  const std::vector<Pose> poses = bodyPoses(ours, drawnCoordinates(ours));
  EXPECT_EQ(ours.bodies.size(), theirs->links_.size());
  for (std::size_t i = 0; i < ours.bodies.size(); ++i) {
    const RobotBody& body = ours.bodies[i];
    SCOPED_TRACE(body.name);
    const auto link = theirs->getLink(body.name);
    ASSERT_TRUE(link);
    const Pose X_WB = placeOf(*link);
    EXPECT_LT((poses[i].p - X_WB.p).norm(), kAlongChains);
    EXPECT_LT(poses[i].q.angularDistance(X_WB.q), 1e-7);  // the arc cosine's of 1 less round-off
    EXPECT_EQ(body.geoms.size(), link->collision_array.size());
    compareMass(*link, body.inertia);
    if (body.joints.size() == 1 && body.joints[0].kind != RobotJointKind::kFree)
      compareJoint(*link->parent_joint, body.joints[0]);
  }
}

TEST(UrdfOracle, LinksAreThoseThatRosReads) {
  compare(PINCER_SOURCE_DIR "/tasks/scenes/files/arm.urdf");
  compare(PINCER_SOURCE_DIR "/tests/fuzz/seeds/urdf/small.urdf");
  if (const char* further = std::getenv("PINCER_URDF")) compare(further);
}

#else

TEST(UrdfOracle, LinksAreThoseThatRosReads) { GTEST_SKIP() << "no liburdfdom-dev here"; }

#endif

}  // namespace
}  // namespace pincer::tasks
