// scratch: working memory of a step, sized once from the model. What the next tick needs of this one is in the state.
// Only WorldSleep outlives a tick, and the results of the last one: contacts, `h` and `solve` stay to be read
// (engine/step.h), and are those of a tick that repeats it.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pincer/contact/surface/patch_cache.h"
#include "pincer/engine/model.h"
#include "pincer/engine/solve/solver_scratch.h"
#include "pincer/engine/state.h"
#include "pincer/engine/step.h"
#include "pincer/engine/world/broad_phase.h"
#include "pincer/engine/world/contact.h"
#include "pincer/engine/world/found_pairs.h"
#include "pincer/engine/world/islands.h"
#include "pincer/engine/world/stage_clock.h"
#include "pincer/engine/world/tree_scratch.h"
#include "pincer/engine/world/world_sleep.h"

namespace pincer::engine {

// Motion of a body or point in this part of the tick.
struct MoverScratch {
  // at the start of the tick; at its end, were there no contact; at its end
  Motion start, free, end;
  Vec3 impulse_W = Vec3::Zero();  // of all contacts [N s]; of what doesn't move, of those of awake bodies
  bool touched = false;           // some contact pushes on it
  // and the last tick's impulses still fit for all that do: slower than this it is at rest (rest.h) [m/s]
  double rest_speed = 0;
  bool closing = false;    // and one of those closes in this tick
  bool still = false;      // of bodies: nothing of its state changed in this tick
  bool unchanged = false;  // of bodies: its course is that of the last attempt, see unchanged_pairs.h
};
// Of a body that rocks in this part of the tick, see rocking.h.
struct Rocking {
  Mat3 wander_W;  // h^2 f W, of all its contacts [kg m^2]
  Mat3 g_W;       // [kg m^2]
  Mat3 root_W;    // F of the inertia I + g [kg^-1/2 m^-1]
  Vec3 w_W;       // with which the pads turn [rad/s]
};
struct BodyScratch : MoverScratch {
  bool rocks = false;
  Pose X_WI_mid, X_WB_mid;
  Pose X_WB_end;                          // of driven bodies
  Mat3 R_WB_mid = Mat3::Identity();       // X_WB_mid.q: a matrix turns many vectors in half the time
  Mat3 inverse_inertia_W = Mat3::Zero();  // at the middle; of bodies in joints, and in impacts
  Vec3 angular_impulse_W = Vec3::Zero();  // about the centre of mass [N m s]
  double flung = 0;  // how far contacts turn a corner of it in this part of the tick, if that is far [m]
  Motion push;       // out of overlap, in this part of the tick, see push_out.h: a way [m] and a turn [rad]
  // the part of it without contact, of joints and torques applied; `free` has what it does
  Vec3 free_angular_impulse_W = Vec3::Zero();
  Rocking rocking;  // without values unless it rocks
};
struct PointScratch : MoverScratch {
  Vec3 p_mid_W = Vec3::Zero();
  Vec3 inverse_mass = Vec3::Zero();  // effective, per axis of A, of the implicit spring-damper [1/kg]
  Vec3 root_inverse_mass = Vec3::Zero();
  Vec3 share_of_end = Vec3::Ones();  // theta, per axis of A: p+ = p + h ((1 - theta) v + theta v+)
  // the length of a part of a tick that these hold for [s], 0: none; and whether the point touched
  double mobility_h = 0;
  bool mobility_touching = false;
  bool has_hollows = false;  // the model's
  int wanders_on = -1;       // body on which the place of its contact `wander_id` wanders as that turns, -1: none
  bool turned = false;       // A isn't W
  bool input_ok = true;
  double inverse_twist = 0;  // effective inverse inertia about A's third axis [1/(kg m^2)]
  double inverse_turn = 0;   // effective inverse inertia of its turning spring [1/(kg m^2)]
  double twist_impulse = 0;  // of all contacts about their normals [N m s]
  Vec3 p_target_W = Vec3::Zero(), v_target_W = Vec3::Zero();  // at the end of the tick
  Vec3 v_tick_W = Vec3::Zero();                               // velocity at the start of the tick
  Vec3 tick_impulse_W = Vec3::Zero();                         // of all contacts over all parts of the tick [N s]
  // Of points that turn, or whose axes do, last: of others no stage reads these lines of the cache.
  Vec3 turn_impulse_W = Vec3::Zero();  // of all contacts about the turning spring [N m s]
  Mat3 R_WA = Mat3::Identity();
  double twist_share_of_end = 1;    // about A's third axis, as share_of_end
  double twist_rate = 0;            // about it, past what the device turns, if nothing touched [rad/s]
  double turn_share_of_end = 1;     // of the turning spring, likewise
  Vec3 told_w_W = Vec3::Zero();     // that of its device [rad/s]
  Vec3 turn_rate_W = Vec3::Zero();  // past that, if nothing touched [rad/s]
  std::uint64_t wander_id = 0;
  Mat3 wander_W = Mat3::Zero();  // W of rocking.h [m]
  double turning_stiffness = 0;  // f kappa of its contacts in hollows, see hollow_inertia.h [N/m]

  // Change of velocity by an impulse.
  Vec3 response(const Vec3& impulse) const {
    if (!turned) return inverse_mass.cwiseProduct(impulse);
    return R_WA * inverse_mass.cwiseProduct(R_WA.transpose() * impulse);
  }
};

// One direction that a joint blocks or brakes, see joints.h.
struct JointRow {
  int a, b;               // bodies, -1 for the world
  Vec3 n_W;               // of the velocities where the joint is; zero for a row of angular velocities
  Vec3 ang_a_W, ang_b_W;  // what multiplies the two angular velocities
  Vec3 m_W;               // the axis of a row of angular velocities; zero for the others
  double softness, bias;  // R and b
  double miss;            // how far the constraint is violated [m, rad]
};
// A held body's coordinate in this part of the tick (held_body.h): its rate at the start and,
// without contact, at the end [rad/s, m/s].
struct HeldScratch {
  Vec3 p_WJ, axis_W;                     // of the joint
  double start_rate = 0, free_rate = 0;  // at the start; at the end, were there no contact
  double free_way = 0;                   // until then [rad, m]
  double inverse_inertia = 0;            // for impulses spread over this part of the tick [1/(kg m^2), 1/kg]
  double gained_rate = 0;                // by contacts
  double gained_way = 0;                 // how far that leads, over its rate [s]
};
struct JointGroupScratch {
  std::vector<JointRow> rows;
  std::vector<double> A, lambda;
  std::vector<int> pivots;
  std::vector<double> basis;   // of the group's scaled velocities, a vector after the other
  std::vector<double> factor;  // F: per body a 6 x kMoverFreedoms block, column-major
  bool sound = true;           // A could be factorised
  bool may_touch = false;      // something can touch one of its bodies, so that F is needed
  bool touched = false;        // something pushed on one of its bodies in this part of the tick
  HeldScratch held;            // of a group that is a held body, instead of rows, A, lambda
};

// A stop of a coordinate, its dry friction, or a drive at its limit: a contact, where it is needed, see joint_rows.h.
// As a mover its velocities are those of the coordinate: along z of a stop, out of it; along x of a brake.
enum class JointRowKind : unsigned char { kLower, kUpper, kFriction, kDrive };
struct JointRowScratch : MoverScratch {
  JointRowKind kind = JointRowKind::kLower;
  int tree = -1;          // -1: what doesn't move, the other side of all of them
  int element = 0;        // coordinate, or drive, of the tree
  bool wanted = false;    // in this part of the tick
  bool locked = false;    // dry friction that holds without a row; its impulse is impulse_W.x
  double mobility = 0;    // of the coordinate to impulses along it [1/kg ..]
  double limit = 0;       // of a brake: the most that it gives [N s]
  double grip = 0;        // of a brake: W_nn of its own mover
  double compliance = 0;  // of a drive: 1/m^
  // Of a stop that the joint hits in this part of the tick: it is left out, and cuts the tick.
  enum class Hit : unsigned char { kNone, kBounces, kLands } hit = Hit::kNone;
  double acceleration = 0;  // out of the stop, without it [m/s^2, rad/s^2]
  bool isBrake() const { return kind == JointRowKind::kFriction || kind == JointRowKind::kDrive; }
};
// A drive in this part of the tick.
struct DriveScratch {
  DriveInput input;  // at the end of it
  DriveMemory mode = DriveMemory::kWithin;
  DriveTick law;                 // without limits
  double mass = 0, impulse = 0;  // m^ and p of that, where it isn't in the tree's own
  double force = 0;              // its mean [N, N m]
};

// Two bodies that may hit each other within the tick.
struct ImpactPair {
  int a = 0, b = 0;
  bool lands = false;  // without bouncing, where it didn't touch; what touches goes on touching
  int stop = -1;       // of WorldScratch::joint_rows: the joint of link a = b hits it; -1: two bodies hit each other
};

// Of a contact between bodies, while overlap is undone (push_out.h).
struct PushedContact {
  double gap = 0;  // after this part of the tick [m]
  double way = 0;  // lambda, by which it pushed the two apart [kg m]
};

// Memory of a contact from before this tick, and its place.
struct KeptMemory {
  Contact* contact;
  const ContactMemory* place;
  ContactMemory memory;
};

// Of a contact, what an attempt at the tick found (tried_impulses.h).
struct TriedImpulse {
  std::uint64_t id;
  double h;  // length of the attempt [s]; 0: a hit, whose impulse doesn't grow with it
  Vec3 impulse_W;
  ContactVector r;
};

// The contacts of the last attempt at a tick, or at a part of it (unchanged_pairs.h).
struct LastAttempt {
  explicit LastAttempt(const WorldModel& model);

  bool is_wanted;                // in this world
  bool is_solved = false;        // scratch.contacts are those of an attempt that is done
  bool serves = false;           // `contacts` may be those of this one, too
  bool something_slept = false;  // then
  bool in_place = false;         // the `kept` ones, which are the first ones of `contacts`, lie there still
  double h = 0, h_last = 0;      // of that attempt [s]
  std::vector<Contact> contacts;
  std::vector<ContactMemory> memories;  // that it began with
  std::vector<int> first_row;
  std::vector<double> q;
  std::size_t kept = 0;                                      // contacts, in this attempt
  std::size_t contact = 0, memory_then = 0, memory_now = 0;  // where the next pair's are looked for
};

struct WorldScratch {
  explicit WorldScratch(const WorldModel& model);

  std::int64_t operations_left = kNoLimit;  // of the solver's budget for this tick (solve/solver_scratch.h)
  std::int64_t hit_operations = 0;          // that solves of what is hit have taken in this tick (budget.h)
  int solves = 0;                           // in this tick
  double h;                                 // length of this part of the tick [s]; 0 in an impact, which takes no time
  Vec3 gravity_W;                           // of this tick [m/s^2]
  std::span<const BodyForce> forces;  // of this tick, one per body, or none; the caller's: not to be read after it
  std::vector<BodyScratch> bodies;
  std::vector<PointScratch> points;
  std::vector<Contact> contacts;  // of what is awake, see forEachContact; capacity options.max_contacts
  int far_contacts = 0;           // of them, see far_contacts.h
  std::vector<int> linked;        // per body, and one more: see Linked there
  std::vector<double> linked_speed2;
  bool contacts_dropped = false;
  // move so fast that the middle of the tick doesn't show whether they meet; capacity as contacts
  std::vector<ImpactPair> fast_pairs;
  std::vector<ImpactPair> pushed_pairs;  // get that fast in this tick (notePushedPairs); capacity as contacts
  std::vector<ImpactPair> impact_pairs;  // hit each other in this part of the tick, or may (impact.h)
  std::vector<ImpactPair> landed_pairs;  // hit each other in this tick without a bounce; capacity as contacts
  std::vector<JointGroupScratch> joint_groups;
  std::vector<TreeScratch> trees;
  std::vector<JointRowScratch> joint_rows;  // three per coordinate of all trees, one per drive, and what doesn't move
  std::vector<DriveScratch> drives;         // of the world
  int joint_contacts = 0;                   // of `contacts`, the last ones
  // what may cut this part of the tick: nothing, bounces, landings as well
  JointRowScratch::Hit stops_hit = JointRowScratch::Hit::kNone;
  bool flings = false;                         // some body's `flung` isn't 0
  std::vector<bool> struck;                    // per body: an impact reaches it
  std::vector<bool> pushed;                    // per body: it is deep in another, or was pushed out of one (push_out.h)
  std::vector<PushedContact> pushed_contacts;  // as `contacts`
  std::vector<KeptMemory> kept;                // of contacts that stand still
  std::vector<TriedImpulse> tried;             // by id; capacity as contacts
  int still_bodies = 0;       // awake ones that could sleep: nothing of their state changed in this tick
  WorldState before, coarse;  // the tick's start, and its end in half as many parts
  double bounce = 1;          // share of the restitution that acts in an impact: less where all of it would add energy
  std::vector<PointInput> point_inputs;    // at the end of this part of the tick
  std::vector<MotionInput> motion_inputs;  // likewise, one per driven body
  std::vector<int> first_row;
  std::vector<double> mu, q, r, u;
  contact::PatchCache patches;
  FoundPairs found_pairs;
  LastAttempt last;
  IslandScratch islands;
  std::unique_ptr<BroadPhase> broad_phase;  // null where every pair is looked at
  SolveResult solve;
  WorldSleep sleep;
  StageClock* clock = nullptr;  // that times the stages (timeStages); null costs nothing
};

// f(contact) for all contacts of the last tick, those of islands that sleep after the others.
template <class F>
void forEachContact(const WorldScratch& scratch, F f) {
  for (const Contact& c : scratch.contacts) f(c);
  for (const SleepingContact& c : scratch.sleep.contacts) f(c.contact);
}

inline const MoverScratch& mover(const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) return scratch.points[side.index];
  if (side.kind == SideKind::kJoint) return scratch.joint_rows[side.index];
  return scratch.bodies[side.index];
}

// The force applied to a body, null if there is none.
inline const BodyForce* forceOn(const WorldScratch& scratch, std::size_t body) {
  return scratch.forces.empty() ? nullptr : &scratch.forces[body];
}

inline void mark(WorldScratch& scratch, Stage stage) {
  if (scratch.clock) scratch.clock->mark(stage);
}

// The place of a further contact with gap `phi`, for the caller to fill in: a contact is too large to copy. When all
// are taken, `contacts_dropped` is set and the shallowest makes room; null if that is the new one.
Contact* addContact(WorldScratch& scratch, double phi);

}  // namespace pincer::engine
