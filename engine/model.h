// model: what a world is made of. Built once by WorldBuilder, checked once, then constant;
// many states may step one model in parallel.
//
// Frames: B as the shape's author chose it; I the body's inertial frame, at its centre of mass, axes principal.
// Dynamics works in I, people read B (bodyPose, state.h).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pincer/contact/error.h"
#include "pincer/contact/shape.h"
#include "pincer/engine/motion.h"
#include "pincer/engine/solver.h"
#include "pincer/engine/tree.h"

namespace pincer::engine {

// Surface of a body. Between two bodies: friction and restitution are the geometric means, torsion and rolling radius
// the larger ones. A finger takes the body's values: skin on plastic is a property of the pair.
struct Material {
  double mu_s = 0.5;          // static friction [-], >= 0
  double mu_d = 0.5;          // dynamic friction [-], 0 <= mu_d <= mu_s
  double restitution = 0;     // of the normal velocity [-], 0 .. 1
  double torsion_radius = 0;  // e_t [m]: the contact carries a torsional moment up to e_t mu f_n; 0 for a point contact
  // e_r [m]: and one that resists rolling, up to e_r mu f_n. All share one cone (docs/engine.md)
  double rolling_radius = 0;
  // v_s [m/s]: what slides at speed v has mu_d + (mu_s - mu_d) exp(-(v/v_s)^2); 0: mu_d at any speed
  double stribeck_speed = 0;
};

// The number of rows that the solver sees of a contact: 3 rows, with torsion 4, with rolling 6.
inline int rowsOf(const Material& m) {
  return m.rolling_radius > 0 ? kMaxContactRows : m.torsion_radius > 0 ? kRollingRow : kPointRows;
}

// Which shapes of different bodies may touch: if (as & other.with) or (other.as & with). Both 0: a
// shape that is only seen, by fingers neither.
struct CollisionBits {
  std::uint32_t as = 1;    // the groups that it is of
  std::uint32_t with = 1;  // the groups that it touches
};
inline bool mayTouch(const CollisionBits& a, const CollisionBits& b) {
  return ((a.as & b.with) | (b.as & a.with)) != 0;
}
inline bool isOnlySeen(const CollisionBits& bits) { return (bits.as | bits.with) == 0; }

// One shape of a body. Most bodies have one, whose frame S is B.
struct ColliderModel {
  int body = 0;
  std::string name;
  contact::Shape shape;
  Pose X_BS;
  bool is_posed = false;  // X_BS isn't the identity
  Material material;
  CollisionBits bits;
  double bounding_radius = 0;  // about S's origin [m]; infinite for half-spaces and dishes
};

struct BodyModel {
  std::string name;
  int first_collider = 0, collider_count = 1;  // its shapes, of WorldModel::colliders
  bool is_plane = false;                       // the only one is a half-space whose frame is B
  bool dynamic = true;                         // false: never moves, or is driven
  bool driven = false;                         // follows the motion that the caller gives, whatever touches it
  int motion = -1;                             // of driven bodies: which of the inputs
  double mass = 0;                             // [kg]; 0 for static and driven bodies
  double inverse_mass = 0;                     // [1/kg]
  double root_inverse_mass = 0;                // its root
  Vec3 moments = Vec3::Zero();                 // principal moments of inertia [kg m^2]
  Pose X_BI;                                   // inertial frame in B; identity for static and driven bodies
  Pose X_IB;
  bool body_is_inertial = true;  // X_IB is the identity
  FreeRotation rotation;
  double bounding_radius = 0;  // about the centre of mass [m]; infinite for half-spaces
  // about half the least thickness of its thinnest shape [m]; infinite for half-spaces and dishes
  double inner_radius = 0;
  double contact_margin = 0;   // within which pairs make contacts, of a dynamic body by its size [m]; see contactMargin
  double corner_reach = 0;     // how much further than that it reaches; 0 where turning doesn't change its outline [m]
  bool may_be_hollow = false;  // its surface may curve inwards: a mesh, a dish, several shapes
  int joint_group = -1;        // that binds it to others or to the world, -1: none
  int tree = -1, link = -1;    // of which it is a link, -1: of none
  bool may_touch = false;      // some pair or point can touch it; the others move in closed form alone
};

// A point that a spring and a damper pull towards a moving target, along each world
// axis on its own: a fingertip, or a probe.
//
//   m a = -k (p - p_target) - d (v - v_target) + f + contact forces
//
// mass 0 gives Colgate's virtual coupling (a massless tip behind a spring-damper); an axis may be locked to the target.
// Source: J. E. Colgate, M. C. Stanley, J. M. Brown, "Issues in the haptic display of tool use", IROS 1995, 140-145.
struct DrivenPointModel {
  std::string name;
  double mass = 0;                        // [kg], >= 0
  Vec3 stiffness = Vec3::Constant(1000);  // k [N/m], >= 0; mass + stiffness must be positive on every free axis
  Vec3 damping = Vec3::Constant(5);       // d [N s/m], >= 0
  // Turns about the contact normal against its own spring: k_tau [N m/rad], d_tau [N m s/rad],
  // both >= 0; both 0: it turns as it is told.
  double twist_stiffness = 0, twist_damping = 0;
  // Turns about every axis through it past what it is told, against a spring without inertia: k_R [N m/rad], d_R [N m
  // s/rad], both >= 0; both 0: as it is told. Not with a twist: that is in it.
  double turn_stiffness = 0, turn_damping = 0;
  Eigen::Array<bool, 3, 1> locked = Eigen::Array<bool, 3, 1>::Constant(false);  // this axis follows its target exactly
};

// How the spring-damper of one axis is integrated, chosen once by the builder.
enum class AxisForm : unsigned char {
  kLocked,  // follows its target
  // Fox-Goodwin quadrature of the spring: 4th order in the tick where the coupling is soft for the proxy's mass
  kFourthOrder,
  kImplicit,  // force at the end of the tick: stable for any stiffness and for massless proxies, 1st order
};

// Friction coefficient of what slides at `speed` [m/s]. Source: R. Stribeck, Z. VDI 46 (1902); the
// exponential form after B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994)
// 1083-1138, eq. (5), with the exponent 2.
double slidingFriction(const Material& m, double speed);

// A pair of bodies that may touch: all that is constant about it.
struct PairModel {
  int a = 0, b = 0;         // bodies, a < b
  Material material;        // of the pair, or combined; of the first of its shapes where one has several (materialOf)
  bool is_of_many = false;  // one of the two has several shapes: materials go by those
};

// Joints that share moving bodies, joints[first] .. joints[first + count - 1].
struct JointGroup {
  int first = 0, count = 0;
  std::vector<int> bodies;  // ascending; static and driven ones don't count
  bool may_touch = false;   // something can touch one of them
  // One body that one pivot or slider holds to what never moves (held_body.h):
  bool is_held_body = false;
  Vec3 axis_A = Vec3::UnitZ();  // of the joint in the body's inertial frame
  double inertia = 0;           // about the pivot's axis [kg m^2], or the mass [kg]
};
constexpr int kMostGroupFreedoms = 48;  // of the bodies of a group that something can touch, without their joints
constexpr int kMostJointRows = 7;       // of one joint: a weld's six, a pivot's five and its damper

constexpr int kMostContacts = 65536;  // chosen: bounds the memory of a tick

// How the frictions of two bodies make that of the pair.
enum class Combination : std::uint8_t {
  kGeometricMean,
  kMaximum,  // as MJCF has it
};

struct WorldOptions {
  double h = 1e-3;                     // tick [s], 1e-5 .. 1e-2
  Vec3 gravity_W = Vec3(0, 0, -9.81);  // [m/s^2]
  // pairs closer than this make contacts, or than a tenth of the smaller one's bounding radius [m], > 0
  double contact_margin = 1e-3;
  // 4 .. kMostContacts; more are dropped, deepest kept, and StepStatus says so; 0: as many as the bodies may well have
  int max_contacts = 0;
  int threads = 1;  // that solve islands, 1 .. 16; the results are the same to the bit
  // Position error per tick that is allowed [m], 0 or 1e-12 .. 1; 0: every tick is one part.
  // Costs three times a plain tick, or more.
  double position_tolerance = 0;
  int max_parts = 16;  // that a tick may be cut into for that, 2 .. 1024; rounded down to a power of two
  Combination combination = Combination::kGeometricMean;  // of frictions
  // what would repeat its last tick to the bit isn't computed: the world (rest.h), islands (island_sleep.h)
  bool sleep = true;
  SolverOptions solver;
};

// Where a joint went.
struct JointPlace {
  int joint = 0;                  // in WorldModel::joints
  int tree = -1, coordinate = 0;  // of a pivot or slider that a tree has; -1: none has it
};

struct WorldModel {
  WorldOptions options;
  std::vector<BodyModel> bodies;
  std::vector<ColliderModel> colliders;  // by bodies; as many as those where each body has one shape
  int shape_bits = 0;  // of a contact's identity that say which of a body's shapes touches (contactId, world/contact.h)
  std::vector<DrivenPointModel> points;
  std::vector<std::array<AxisForm, 3>> point_forms;
  bool has_corners = false;  // of dynamic bodies: some corner_reach isn't 0
  bool has_hollows = false;  // that points may touch: there are points, and bodies that may be hollow
  // only those that can touch: at least one dynamic, shapes supported; none with a broad phase
  std::vector<PairModel> pairs;
  bool has_broad_phase = false;  // of more than kAllPairsBodies bodies: pairs are found tick by tick (broad_phase.h)
  std::vector<std::pair<int, int>> excluded_pairs;  // sorted; only with a broad phase
  std::vector<PairModel> special_pairs;             // with a material of their own, sorted
  std::vector<JointModel> joints;                   // by groups
  std::vector<JointGroup> joint_groups;
  std::vector<JointPlace> joint_places;  // as addJoint numbered them
  std::vector<TreeModel> trees;          // of the joints that no group has
  std::vector<DriveModel> drives;        // their terms by places in `joints`
  int tree_q_count = 0, tree_coordinate_count = 0, tree_v_count = 0, tree_block_count = 0;
  bool bounces = false;  // some pair has restitution
  int driven_count = 0;  // of bodies
};

inline bool isHeldBody(const WorldModel& model, const BodyModel& body) {
  return body.joint_group >= 0 && model.joint_groups[body.joint_group].is_held_body;
}

// Bodies that are closer than this, and than they come in a tick, make contacts [m].
inline double contactMargin(const BodyModel& a, const BodyModel& b) {
  return std::min(a.contact_margin, b.contact_margin);
}

inline bool isJoined(const BodyModel& body) { return body.joint_group >= 0 || body.tree >= 0; }

inline std::span<const ColliderModel> collidersOf(const WorldModel& model, const BodyModel& body) {
  return {model.colliders.data() + body.first_collider, static_cast<std::size_t>(body.collider_count)};
}

// One of several shapes of a body, as the builder is told.
struct ColliderSpec {
  std::string name;
  contact::Shape shape;
  Pose X_BS;
  std::optional<Material> material = std::nullopt;  // else the body's
  double mass = 0;  // its share of the body's [kg], >= 0; 0: by volume, of what the others leave
  CollisionBits bits = {};
};

// An inertia that is known, in place of that of homogeneous shapes.
struct GivenInertia {
  Vec3 p_BBcm = Vec3::Zero();  // centre of mass [m]
  Mat3 I_BBcm = Mat3::Zero();  // about the centre of mass, in B's axes [kg m^2]
};

// A body, as the builder is told; B's pose and velocity at the start live in BodyStart.
struct BodySpec {
  std::string name;
  contact::Shape shape;  // if `shapes` is empty
  bool dynamic = true;
  double mass = 0;  // [kg], > 0 for dynamic bodies; 0 takes the sum of the shapes', if each has one
  Material material;
  bool driven = false;  // not dynamic, but moves as the caller says
  std::vector<ColliderSpec> shapes = {};
  std::optional<GivenInertia> inertia = std::nullopt;
};

// Collects bodies and points, checks them, and builds the model. Every error names the body, the
// value, its range and a remedy (InputError).
class WorldBuilder {
 public:
  explicit WorldBuilder(const WorldOptions& options);
  int addBody(const BodySpec& spec);            // returns the body's index
  int addPoint(const DrivenPointModel& point);  // returns the point's index
  int addJoint(const JointModel& joint);        // returns the joint's index in the order of calls; the two never touch
  int addCoupling(const CouplingModel& coupling);  // returns its index
  int addDrive(const DriveModel& drive);           // returns its index
  void excludePair(int a, int b);                  // these two never touch
  // of these two, in place of the combination of theirs; the last one counts
  void setPairMaterial(int a, int b, const Material& material);
  WorldModel build() const;  // joints in the order of their groups

 private:
  WorldModel model_;
  std::vector<std::pair<int, int>> excluded_;
  std::vector<CouplingModel> couplings_;
};

Material combine(const Material& a, const Material& b, Combination rule = Combination::kGeometricMean);

// Of two bodies, a < b: their own, or combined of their first shapes' materials.
Material materialOf(const WorldModel& model, int a, int b);
// Of two shapes, of bodies a.body < b.body: the bodies' own, or combined of the two materials.
Material materialOf(const WorldModel& model, const ColliderModel& a, const ColliderModel& b);

}  // namespace pincer::engine
