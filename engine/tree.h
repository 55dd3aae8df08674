// tree: joints with limits, springs, drives and dry friction, and the trees of bodies that hang together by them.
//
//   l = sum of c_j q_j
//   F = f + k (target - l) + d (target' - l'),   lower_force <= F <= upper_force   (a drive on one joint or a tendon)
//
//   q_j  a joint's coordinate: what a has turned about J's z axis [rad], or gone along it [m],
//        past b; 0 where J of a and J of b coincide
// Positions q and velocities v of all trees lie in WorldState::tree_q and tree_v; links' BodyState follows from them
// after each tick. Source: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapters 4 to 6.
#pragma once
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "pincer/contact/math.h"

namespace pincer::engine {

// Freedoms that a joint leaves, in its frame J.
enum class JointKind : unsigned char {
  kPivot,   // a turns about J's z axis
  kSlider,  // a slides along J's z axis
  kBall,    // a turns about J's origin
  kWeld,    // nothing
};

// Limits of a pivot's or slider's coordinate, and all that acts on it besides its damping. [N
// m/rad ..] of pivots, [N/m ..] of sliders.
struct JointTraits {
  double lower = -std::numeric_limits<double>::infinity();  // limits of q [rad, m]: stops
  double upper = std::numeric_limits<double>::infinity();
  double restitution = 0;  // of the stops [-], 0 .. 1
  double stiffness = 0;    // of a spring [N m/rad, N/m], >= 0
  double rest = 0;         // where it is slack [rad, m]
  double friction = 0;     // dry: holds up to so much, and brakes with it [N m, N], >= 0
  // inertia that turns with the coordinate alone, of motor and gear [kg m^2, kg], >= 0; of balls about each axis
  double armature = 0;
  double start = 0;  // of pivots: about where it is at the start, which full turn it is in [rad]

  bool operator==(const JointTraits&) const = default;
};

struct JointModel {
  JointKind kind = JointKind::kPivot;
  int a = 0, b = -1;  // bodies; b = -1: the world. a is dynamic
  // J in the two inertial frames (in W for the world); as given to the builder: in the bodies' own frames
  Pose X_AJ, X_BJ;
  double damping = 0;  // of the free axis [N m s/rad] or [N s/m], >= 0
  std::string name = {};
  JointTraits traits = {};
};

// q of `joint` is the polynomial c_0 + c_1 q_l + c_2 q_l^2 + .. of the joint
// that it follows. Both are pivots or sliders.
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
  double lower_control = -std::numeric_limits<double>::infinity();  // u is cut off there
  double upper_control = std::numeric_limits<double>::infinity();
};

// Control of a drive for one tick.
struct DriveInput {
  double value = 0;    // u at the end of the tick
  double rate = 0;     // u' there, if it moves [1/s]
  bool moves = false;  // u goes from where it was to there during the tick; else it is `value` all through it

  bool operator==(const DriveInput&) const = default;
};

// ---------------------------------------------------------------- what the builder makes of them

// One body of a tree and the joint that holds it to its parent.
struct TreeLink {
  int body = 0;
  int parent = -1;  // link; -1: the base
  JointKind kind = JointKind::kPivot;
  bool reversed = false;  // the joint's b is the link, its a the parent: pivots and sliders move by -q
  // in q of the tree: 1 number, a ball 4 (a quaternion w, x, y, z: J of the link in J of the parent), a weld none
  int first_q = 0;
  // of its coordinates: 1, a ball 3 (angular velocity of the link past its parent, in J of the parent), a weld none
  int first_v = 0;
  Pose X_PJ, X_LJ;              // J in the inertial frames of parent (W or the base body's) and link
  double mass = 0;              // [kg]
  Vec3 moments = Vec3::Zero();  // principal, in the link's inertial frame [kg m^2]
  int tip = -1;                 // the column on whose path lie all that move it; -1: none do
};
inline int coordinatesOf(JointKind kind) { return kind == JointKind::kWeld ? 0 : kind == JointKind::kBall ? 3 : 1; }

// One velocity v_i of the tree.
struct TreeCoordinate {
  int link = 0;
  int joint = 0;    // of WorldModel::joints
  int q = -1;       // in q of the tree; -1 of balls
  int parent = -1;  // the coordinate before it on the way to the base
  int column = 0;   // of the equations; of what follows another that one's
  double damping = 0;
  JointTraits traits;
  int leader = -1;  // the coordinate that it follows
  std::array<double, 5> polynomial{};
};

// Spring, damper or drive on l = sum of factors times coordinates.
struct TreeDrive {
  int drive = 0;  // of WorldModel::drives
  struct Term {
    int coordinate;
    double factor;
  };
  std::vector<Term> terms;
};

// A joint beside the tree, between two links or a link and the base: it closes a loop.
struct TreeLoop {
  int joint = 0;  // of WorldModel::joints
  JointKind kind = JointKind::kBall;
  int a = 0, b = -1;  // links; b = -1: the base
  Pose X_AJ, X_BJ;    // J in their inertial frames (W or the base body's)
};
// Rows of a loop: of its point, and with its turns.
inline int pointRowsOf(JointKind kind) { return kind == JointKind::kSlider ? 2 : 3; }
inline int rowsOf(JointKind kind) { return kind == JointKind::kWeld ? 6 : kind == JointKind::kBall ? 3 : 5; }

// A run of at most six columns: one mover of the contact problem.
struct TreeBlock {
  int first = 0, count = 0;  // its innermost column (the next ones follow by `before`), and how many
  int parent = -1;           // the block before it on the way to the base
};

struct TreeModel {
  int base = -1;                            // static or driven body that carries it; -1: the world
  std::vector<TreeLink> links;              // parents first
  std::vector<TreeCoordinate> coordinates;  // by links
  std::vector<TreeDrive> drives;
  std::vector<TreeLoop> loops;  // with any, all columns are one path
  int blocked = 0;              // directions that the loops take wherever they are (engine/tree/loop_basis.h)
  // The equations' columns: column c depends on those that before[c], before[before[c]] .. name. That of a tree without
  // ties is that of its branches; what a tendon or a coupling ties across branches is one chain.
  std::vector<int> before;
  std::vector<int> column_coordinate;  // the coordinate that a column is the rate of
  std::vector<int> block_of;           // per column
  std::vector<int> column_in_block;    // its place there
  // The packed matrix of the equations (engine/tree/sparse_ldl.h): entries of column c from row[c] on, of each
  // column on its path by depth, its own last.
  std::vector<int> depth, row;
  int entries = 0;
  std::vector<TreeBlock> blocks;
  int first_q = 0, first_v = 0, first_block = 0;  // of this tree in the world's: q's numbers, columns, blocks
  int first_coordinate = 0;                       // likewise
  int q_count = 0;
  bool has_couplings = false;
  bool may_touch = false;  // something can touch one of its links

  int columnCount() const { return static_cast<int>(before.size()); }
  // Of the columns that are left once loops are closed.
  int freedomCount() const { return columnCount() - blocked; }
  int coordinateCount() const { return static_cast<int>(coordinates.size()); }
};

}  // namespace pincer::engine
