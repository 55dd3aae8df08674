// tree: joints with limits, springs, drives and dry friction, and the trees of bodies that hang together by them.
//
//   l = sum of c_j q_j        F = f + k (target - l) + d (target' - l'),   lower_force <= F <= upper_force        (a drive on one joint or a tendon)
//
//   q_j  a joint's coordinate: what a has turned about J's z axis [rad], or gone along it [m], past b; 0 where J of a and J of b coincide
// Positions q and velocities v of all trees lie in WorldState::tree_q and tree_v; links' BodyState follows from them after each tick.
// Source: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapters 4 to 6.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::engine {

// What a joint leaves free, in its frame J.
enum class JointKind : unsigned char {
  kPivot,   // a turns about J's z axis
  kSlider,  // a slides along J's z axis
  kBall,    // a turns about J's origin
  kWeld,    // nothing
};

// What acts on the coordinate of a pivot or slider besides its damping. [N m/rad ..] of pivots, [N/m ..] of sliders.
struct JointTraits {
  double lower = -std::numeric_limits<double>::infinity();  // limits of q [rad, m]: stops
  double upper = std::numeric_limits<double>::infinity();
  double restitution = 0;  // of the stops [-], 0 .. 1
  double stiffness = 0;    // of a spring [N m/rad, N/m], >= 0
  double rest = 0;         // where it is slack [rad, m]
  double friction = 0;     // dry: holds up to so much, and brakes with it [N m, N], >= 0
  double armature = 0;     // inertia that turns with the coordinate alone, of motor and gear [kg m^2, kg], >= 0; of balls about each axis
  double start = 0;        // of pivots: about where it is at the start, which full turn it is in [rad]

  bool operator==(const JointTraits&) const = default;
};

struct JointModel {
  JointKind kind = JointKind::kPivot;
  int a = 0, b = -1;   // bodies; b = -1: the world. a is dynamic
  Pose X_AJ, X_BJ;     // J in the two inertial frames (in W for the world); as given to the builder: in the bodies' own frames
  double damping = 0;  // of the free axis [N m s/rad] or [N s/m], >= 0
  std::string name = {};
  JointTraits traits = {};
};

// q of `joint` is the polynomial c_0 + c_1 q_l + c_2 q_l^2 + .. of the joint that it follows. Both are pivots or sliders.
struct CouplingModel {
  int joint = 0, follows = 0;  // as addJoint numbers them
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};
};

struct DriveTerm {
  int joint = 0;  // as addJoint numbers them
  double factor = 1;
};
// A motor, servo or spring that pushes one joint, or several through a tendon.
struct DriveModel {
  std::string name;
  std::vector<DriveTerm> terms;  // l = sum of factor q
  double gain = 1;               // f = offset + gain times the control, of motors
  double offset = 0;             // [N, N m]
  double stiffness = 0;          // k, towards the control [N/m, N m/rad], >= 0
  double damping = 0;            // d [N s/m, N m s/rad], >= 0
  enum class Control : unsigned char {
    kForce,     // f = offset + gain u; k and d pull towards l = 0 and l' = 0
    kPosition,  // target = u; f = offset
    kVelocity,  // target' = u; f = offset, k = 0
  } control = Control::kForce;
  double lower_force = -std::numeric_limits<double>::infinity();  // [N, N m]
  double upper_force = std::numeric_limits<double>::infinity();
};

// What a drive is told for one tick.
struct DriveInput {
  double value = 0;    // u at the end of the tick
  double rate = 0;     // u' there, if it moves [1/s]
  bool moves = false;  // u goes from where it was to there during the tick; else it is `value` all through it

  bool operator==(const DriveInput&) const = default;
};

// ---------------------------------------------------------------- what the builder makes of them (engine/world/tree_builder.h)

// One body of a tree and the joint that holds it to its parent.
struct TreeLink {
  int body = 0;
  int parent = -1;  // link; -1: the base
  JointKind kind = JointKind::kPivot;
  int first_q = 0;  // 1 number; of a ball 4: the quaternion w, x, y, z of J on the link in J on the parent; of a weld none
  int first_rate = 0,
      rate_count = 0;           // 1; of a ball 3: the angular velocity of the link past its parent, in J of the parent; of a weld none
  int tip = -1;                 // the last freedom of those that move it; -1: none
  Pose X_PJ, X_JL;              // J in the inertial frame of the parent (W or the base body's); the link's inertial frame in J
  double mass = 0;              // [kg]
  Vec3 moments = Vec3::Zero();  // principal, in the link's inertial frame [kg m^2]
};
inline int ratesOf(JointKind kind) { return kind == JointKind::kWeld ? 0 : kind == JointKind::kBall ? 3 : 1; }
inline int numbersOf(JointKind kind) { return kind == JointKind::kBall ? 4 : ratesOf(kind); }

// The rate of one joint, and what acts on it. Most are freedoms themselves; those of joints that follow others are shares of these.
struct TreeRate {
  int link = 0;
  int joint = 0;    // of WorldModel::joints
  int q = -1;       // its coordinate, in q of the tree; -1 of balls
  int freedom = 0;  // its own, or that of the joint that it follows
  int leader = -1;  // the rate that it follows
  std::array<double, 5> polynomial{};
  double armature = 0;
};

// One column of the equations. M couples it with those on its path: parent, its parent ..
struct TreeFreedom {
  int rate = 0;
  int parent = -1;  // the freedom before it on its path; of what a tendon or a coupling ties across branches all are one path
  int depth = 0;    // how many come before it
  int row = 0;      // of its entries in M, entry row + depth of those on its path and of itself
  int block = 0;
};

// Spring, damper or drive along l = sum of factor q.
struct TreeElement {
  struct Term {
    int rate;
    double factor;
  };
  std::vector<Term> terms;
  double stiffness = 0, damping = 0;
  double rest = 0;  // of springs of joints: where l is slack
  int drive = -1;   // of WorldModel::drives; -1: spring and damper of a joint
};

// A run of at most six freedoms: one mover of the contact problem.
struct TreeBlock {
  int first = 0, count = 0;  // freedoms
  int parent = -1;           // the block before it on the way to the base
};

struct TreeModel {
  int base = -1;                // static or driven body that carries it; -1: the world
  std::vector<TreeLink> links;  // parents first
  std::vector<TreeRate> rates;  // by links
  std::vector<TreeFreedom> freedoms;
  std::vector<TreeElement> elements;
  std::vector<TreeBlock> blocks;
  int q_count = 0, entries = 0;                         // numbers of q, of M
  int first_q = 0, first_freedom = 0, first_block = 0;  // of this tree in all of the world's
  bool may_touch = false;                               // something can touch one of its links
};

}  // namespace pincer::engine
