// premium_kinematics: forward, inverse and differential kinematics of an arm like a Phantom
// Premium 1.5 (without its passive gimbal).
//
//   r = l1 cos q2 + l2 sin q3                           horizontal reach from the vertical axis [m]
//   p_DF = (r sin q1,  l2 - l2 cos q3 + l1 sin q2,  r cos q1 - l1)
//   v_DF = J(q) qdot,   tau = J(q)^T f_D,   det J = r l1 l2 cos(q2 - q3)
//
// q = (q1, q2, q3) [rad]: turn of the base about D's y axis; elevation of the upper link; deviation of the fore link
// from hanging straight down. q2 and q3 are both measured from the ground, because a parallelogram drives the fore
// link. q = 0 is the reset place, p_DF = 0. D: x right, y up, z towards the operator; its origin is the fingertip at
// the reset place, the shoulder is at (0, l2, -l1). Singular where r = 0 (fingertip on the vertical axis) and where |q2
// - q3| = pi/2 (links in line: stretched or folded). Source: M. C. Cavusoglu, D. Feygin, F. Tendick, Presence 11 (2002)
// 555-568, sections 3 and 4; derived again here, J checked against differences of the forward kinematics in the tests.
#pragma once
#include <optional>

#include "pincer/devices/math.h"

namespace pincer::devices::premium {

inline constexpr double l1 = 0.215;  // upper link [m]
inline constexpr double l2 = 0.170;  // fore link [m]

// Stops of the joints [rad]. Their places are ours (the maker publishes only the workspace);
// they keep clear of the singular postures.
struct JointLimits {
  Vec3 min{-1.1, -0.8, -0.8};
  Vec3 max{1.1, 1.4, 1.3};
  double elbow = 1.3;  // largest |q2 - q3|
};

// A box [m] within the stops, clear of singular postures (dexterity > 0.5), where the bare arm's apparent mass is 27 to
// 160 g. Ours; the maker's 191 x 267 x 381 mm is the extent of a workspace that isn't a box.
inline const Vec3 kWorkspaceMin_D{-0.10, -0.06, -0.06};
inline const Vec3 kWorkspaceMax_D{0.10, 0.10, 0.05};

// Sines and cosines of the joint angles `q` [rad], so that who asks for several things at one place takes them once.
struct JointSines {
  double s1, c1, s2, c2, s3, c3;
  explicit JointSines(const Vec3& q);
};

// The fingertip p_DF [m] at joint angles `q` [rad].
Vec3 forward(const JointSines& at);
inline Vec3 forward(const Vec3& q) { return forward(JointSines(q)); }

// The joint angles of `p_DF` with the elbow up and r >= 0; absent where the
// links can't reach. Stops are not considered.
std::optional<Vec3> inverse(const Vec3& p_DF);

// d p_DF / d q [m/rad].
Mat3 jacobian(const JointSines& at);
inline Mat3 jacobian(const Vec3& q) { return jacobian(JointSines(q)); }

// Signed distance from the singular postures: det J over its value at the reset place (1 there, 0 where singular) [-].
double dexterity(const Vec3& q);

// True if `q` keeps to the stops.
bool withinLimits(const JointLimits& limits, const Vec3& q);

}  // namespace pincer::devices::premium
