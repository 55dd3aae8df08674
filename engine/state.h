// state: all of a world that evolves, and nothing else. Copies by value; a snapshot is a copy; restoring one and
// giving the same inputs gives the same bits.
#pragma once
#include <cstdint>
#include <vector>

#include "pincer/engine/model.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

struct BodyState {
  Pose X_WI;                // inertial frame in W
  Vec3 v_W = Vec3::Zero();  // of the centre of mass [m/s]
  Vec3 L_W = Vec3::Zero();  // angular momentum about the centre of mass [kg m^2/s]; zero of what isn't dynamic
};

struct PointState {
  Vec3 p_W = Vec3::Zero();         // [m]
  Vec3 v_W = Vec3::Zero();         // [m/s]
  Vec3 p_target_W = Vec3::Zero();  // where the target was at the end of the last tick
  Vec3 v_target_W = Vec3::Zero();
  bool touching = false;            // a contact pushed on it in the last tick
  double twist = 0;                 // by which it has turned past its device about the contact normal [rad]
  double twist_rate = 0;            // [rad/s]
  Vec3 turn_W = Vec3::Zero();       // by which it has turned past its device, a rotation vector [rad]
  Vec3 turn_rate_W = Vec3::Zero();  // [rad/s]
};

// A contact's memory from tick to tick. Sorted by id.
struct ContactMemory {
  std::uint64_t id = 0;                     // see contactId
  ContactVector r = ContactVector::Zero();  // impulse in C (t1, t2, n, torsion, rolling) [N s]; warm start
  Vec3 t1_W = Vec3::UnitX();                // first tangent of C, so that r keeps its meaning when n turns
  Vec3 n_W = Vec3::UnitZ();
  Vec3 arm_a_W = Vec3::Zero(), arm_b_W = Vec3::Zero();  // contact point from the two centres [m]
  // How far a has moved past b since they stuck: along t1, t2 [m]; the overlap that friction holds shut, at most 0 [m];
  // about n, t1, t2 [rad].
  ContactVector offset_C = ContactVector::Zero();
  bool active = false;    // pushed in the last tick
  bool anchored = false;  // offset_C holds: it sticks, or did a moment ago, or lies in a face that does
  bool sliding = false;
  bool closing = false;  // it closed in the last tick
  // for which it has been open, by so little that it may close again at once; kOpenTicks: no longer
  int open_ticks = 0;
  int settling = 0;  // for so many ticks a warm start must be exact to round-off (solve/contact_solver.h)
};

// For how many ticks a contact that opens by next to nothing keeps its impulse and its offset.
constexpr int kOpenTicks = 8;

// A drive's work in the last tick.
// its limits; at one of them; it may be either
enum class DriveMemory : unsigned char { kWithin, kLow, kHigh, kUnsure };
// Deed of dry friction: held, or braked what moves. kLocks: it held with half of its force to
// spare, and nothing touched what it holds.
enum class BrakeMemory : unsigned char { kHolds, kForward, kBackward, kLocks };

struct WorldState {
  double time = 0;  // [s]
  std::int64_t tick = 0;
  int parts = 1;      // that the last tick was cut into by the tolerance
  double h_last = 0;  // length of the last part of a tick [s], see world/stages.h; 0 before the first
  std::vector<BodyState> bodies;
  std::vector<Vec3> driven_w_W;  // angular velocities of driven bodies, by BodyModel::motion [rad/s]
  std::vector<PointState> points;
  std::vector<double> tree_q, tree_v;  // coordinates, and velocities by columns, of all trees (tree.h)
  std::vector<DriveInput> controls;    // of the last tick, per drive
  std::vector<DriveMemory> drives;     // per drive
  std::vector<BrakeMemory> brakes;     // per coordinate of all trees
  // always options.max_contacts of them, so that no tick allocates; the first contact_count count
  std::vector<ContactMemory> contacts;
  int contact_count = 0;
};

// Pose X_WB and velocity of a body's own frame B at the start.
struct BodyStart {
  Pose X_WB;
  Vec3 v_W = Vec3::Zero();  // of the centre of mass [m/s]
  Vec3 w_W = Vec3::Zero();  // [rad/s]
};

// State with every body at `starts` (one per body) and every point at rest on its target `points` (one per point).
// Throws InputError when sizes differ or a value isn't finite.
WorldState makeState(const WorldModel& model, const std::vector<BodyStart>& starts, const std::vector<Vec3>& points);

// Between two ticks: room for `contacts`, after a tick whose status was kContactsDropped. What the state remembers
// stays as it is; the model's other states are to be grown too, and its scratch is to be made anew. `contacts`: not
// fewer than there is room for, at most kMostContacts; or throws InputError.
void growContacts(int contacts, WorldModel& model, WorldState& state);

// Of a pivot or slider, numbered as the builder did: of one that no tree has the angle within half a turn of
// JointTraits::start. setJoint needs one that a tree has, and places the links that it carries, too.
double jointPosition(const WorldModel& model, const WorldState& state, int joint);  // q [rad, m]
double jointVelocity(const WorldModel& model, const WorldState& state, int joint);  // [rad/s, m/s]
void setJoint(const WorldModel& model, WorldState& state, int joint, double position, double velocity = 0);

Pose bodyPose(const WorldModel& model, const WorldState& state, int body);             // X_WB
Vec3 bodyAngularVelocity(const WorldModel& model, const WorldState& state, int body);  // w_WB [rad/s]
double kineticEnergy(const WorldModel& model, const WorldState& state);                // of all bodies [J]
double potentialEnergy(const WorldModel& model, const WorldState& state);  // in gravity, zero at W's origin [J]
double potentialEnergy(const WorldModel& model, const WorldState& state, const Vec3& gravity_W);  // in another [J]

// FNV-1a hash over every bit of the state: equal states, equal hashes, on every machine.
std::uint64_t hashOf(const WorldState& state);

}  // namespace pincer::engine
