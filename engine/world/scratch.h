// scratch: working memory of a step, sized once from the model. Nothing in it survives a tick but memory; read it after a step to see the
// contacts of that step.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "contact/surface/patch_cache.h"
#include "engine/motion/driven_motion.h"
#include "engine/solve/cascade.h"
#include "engine/world/broad_phase.h"
#include "engine/world/islands.h"
#include "engine/world/model.h"
#include "engine/world/stage_clock.h"
#include "engine/world/state.h"

namespace pincer::engine {

enum class SideKind : std::uint8_t { kBody, kPoint };

struct MoverScratch;

// One of the two that touch.
struct Side {
  SideKind kind = SideKind::kBody;
  int index = 0;
};

// A contact of this tick: n_W points out of b towards a. All geometry is that of the predicted middle of the tick.
struct Contact {
  // Whoever adds it gives it these, of R_WC the third column.
  std::uint64_t id = 0;
  Side a, b;
  Vec3 p_W;        // where they touch [m]
  Mat3 R_WC;       // columns (t1, t2, n)
  double phi = 0;  // gap [m]
  Material material;
  // Filled by the step, without a value before.
  const ContactMemory* memory;            // of the last tick, null for a new contact; until this one is remembered
  const MoverScratch *mover_a, *mover_b;  // of a and b
  double mu;                              // in force in this tick
  Vec3 arm_a_W, arm_b_W;
  // Of these two rows that the contact doesn't have stay without a value.
  ContactVector v_start_C;  // of a relative to b at the start of the tick, see relativeVelocity
  ContactVector offset_C;   // anchored stick, at the start of the tick; see ContactMemory
  bool closing = false;     // it closes in this tick, from a positive gap or with an approaching velocity
  bool stuck = false;       // it stuck in the last tick: its tangential biases undo the offset
  ContactVector bias_C;     // part of q that isn't velocity [m/s], from torsion on [rad/s]
  ContactVector r;          // impulse on a in C [N s]
  Vec3 impulse_W;           // impulse on a at p_W [N s]; b got exactly its negative
  Vec3 u_C;                 // velocity of a relative to b at the end of the tick, biases included [m/s]
  bool sliding = false;
  int settling = 0;     // see ContactMemory; of the last tick before the solve, of this one after it
  bool quiet = false;   // the last tick's impulses still fit
  bool yields = false;  // walls close on what is between them (solve/squeeze.h)
  bool still = false;   // and nothing of it or of its bodies changed in this tick, where that was asked

  Contact() {}  // NOLINT(modernize-use-equals-default): a defaulted one would clear all of a new contact
  Vec3 n_W() const { return R_WC.col(2); }
  bool active() const { return r[2] > 0; }
};

// What a driven body does at the end of the tick: pose of its frame B, velocity of B's origin, angular velocity.
using MotionInput = DrivenPlace;

// Where a driven point's target is at the end of the tick, and a force on the point over the tick.
struct PointInput {
  Vec3 p_target_W = Vec3::Zero();  // [m]
  Vec3 v_target_W = Vec3::Zero();  // [m/s]
  Vec3 f_W = Vec3::Zero();         // [N]
  Vec3 w_W = Vec3::Zero();         // with which what the point stands for turns, over the tick [rad/s]
  // Axes A of the coupling where they aren't the world's: frameFromNormal of this unit vector, the axis of its twist (contact/math.h).
  bool turned = false;
  Vec3 n_W = Vec3::UnitZ();
};

// What a body or point went through in this part of the tick.
struct MoverScratch {
  Motion start, free, end;        // at the start of the tick; at its end, were there no contact; at its end (of bodies: if touched)
  Vec3 impulse_W = Vec3::Zero();  // of all contacts [N s]; of what doesn't move, of those of awake bodies
  bool touched = false;           // some contact pushes on it
  bool quiet = false;             // and the last tick's impulses still fit for all that do
  bool closing = false;           // and one of those closes in this tick
  bool still = false;             // of bodies: nothing of its state changed in this tick
};
struct BodyScratch : MoverScratch {
  Pose X_WI_mid, X_WB_mid;
  Pose X_WB_end;                                // of driven bodies
  Mat3 R_WB_mid = Mat3::Identity();             // X_WB_mid.q: a matrix turns many vectors in half the time
  Mat3 inverse_inertia_W = Mat3::Zero();        // at the middle; of bodies in joints, and in impacts
  Vec3 angular_impulse_W = Vec3::Zero();        // about the centre of mass [N m s]
  double flung = 0;                             // how far contacts turn a corner of it in this part of the tick, if that is far [m]
  Motion push;                                  // out of overlap, in this part of the tick, see push_out.h: a way [m] and a turn [rad]
  Vec3 joint_angular_impulse_W = Vec3::Zero();  // the part of it that joints would give without contact; its linear part is in `free`
};
struct PointScratch : MoverScratch {
  Vec3 p_mid_W = Vec3::Zero();
  Vec3 inverse_mass = Vec3::Zero();  // effective, per axis of A, of the implicit spring-damper [1/kg]
  Vec3 root_inverse_mass = Vec3::Zero();
  Vec3 share_of_end = Vec3::Ones();  // theta, per axis of A: p+ = p + h ((1 - theta) v + theta v+)
  double mobility_h = 0;             // the length of a part of a tick that these hold for [s], 0: none; and whether the point touched
  bool mobility_touching = false;
  bool has_hollows = false;  // the model's
  bool turned = false;       // A isn't W
  Mat3 R_WA = Mat3::Identity();
  double inverse_twist = 0;                                   // effective inverse inertia about A's third axis [1/(kg m^2)]
  double twist_share_of_end = 1;                              // likewise
  double twist_rate = 0;                                      // about it, past what the device turns, if nothing touched [rad/s]
  double turning_stiffness = 0;                               // f kappa of its contacts in hollows, see hollow_inertia.h [N/m]
  double twist_impulse = 0;                                   // of all contacts about their normals [N m s]
  Vec3 p_target_W = Vec3::Zero(), v_target_W = Vec3::Zero();  // at the end of the tick
  Vec3 v_tick_W = Vec3::Zero();                               // velocity at the start of the tick
  Vec3 tick_impulse_W = Vec3::Zero();                         // of all contacts over all parts of the tick [N s]
  bool input_ok = true;

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
// A held body's coordinate in this part of the tick (held_body.h): its rate at the start and, without contact, at the end [rad/s, m/s].
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
  HeldScratch held;            // of a group that is a held body, instead of rows, A, lambda
};

// Two bodies that may hit each other within the tick.
struct ImpactPair {
  int a = 0, b = 0;
  bool lands = false;  // without bouncing, where it didn't touch; what touches goes on touching
};

// A tick that ended where it started, to the bit, see rest.h.
struct RestScratch {
  WorldState state;  // where
  std::vector<PointInput> points;
  std::vector<MotionInput> motions;
  bool candidate = false;  // `state` is how the last tick ended
  bool holds = false;      // and how it started, with these inputs
};

// A contact of an island that sleeps, as it was in the last tick that was computed.
struct SleepingContact {
  Contact contact;
  ContactMemory memory;
  int place;  // of that in WorldState::contacts
};

// What was remembered of a contact before this tick, and where.
struct KeptMemory {
  Contact* contact;
  const ContactMemory* place;
  ContactMemory memory;
};

// See island_sleep.h.
struct SleepScratch {
  int bodies = 0;                         // that sleep
  int still_bodies = 0;                   // awake ones that could: nothing of their state changed in this tick
  int last_group = 0;                     // number of the island that fell asleep last
  std::size_t room = 0;                   // for contacts of what is awake
  std::vector<char> idle;                 // per body: it sleeps, or is static or driven and stands; only where `bodies` isn't 0
  std::vector<int> group;                 // per body: which island it sleeps with, 0: none
  std::vector<BodyState> states;          // of those that are idle
  std::vector<SleepingContact> contacts;  // sorted by id
  std::vector<KeptMemory> kept;           // working memory
};

struct WorldScratch {
  explicit WorldScratch(const WorldModel& model);

  std::int64_t operations_left = kNoLimit;  // of the solver's budget for this tick (solve/cascade.h)
  double h;                                 // length of this part of the tick [s]; 0 in an impact, which takes no time
  std::vector<BodyScratch> bodies;
  std::vector<PointScratch> points;
  std::vector<Contact> contacts;  // of what is awake, see forEachContact; capacity options.max_contacts
  bool contacts_dropped = false;
  std::vector<ImpactPair> fast_pairs;    // move so fast that the middle of the tick doesn't show whether they meet; capacity as contacts
  std::vector<ImpactPair> pushed_pairs;  // get that fast in this tick (notePushedPairs); capacity as contacts
  std::vector<ImpactPair> impact_pairs;  // hit each other in this part of the tick, or may (impact.h)
  std::vector<JointGroupScratch> joint_groups;
  bool flings = false;        // some body's `flung` isn't 0
  std::vector<bool> struck;   // per body, in an impact
  WorldState before, coarse;  // the tick's start, and its end in half as many parts
  RestScratch rest;
  double bounce = 1;                       // share of the restitution that acts in an impact: less where all of it would add energy
  std::vector<PointInput> point_inputs;    // at the end of this part of the tick
  std::vector<MotionInput> motion_inputs;  // likewise, one per driven body
  std::vector<int> first_row;
  std::vector<double> mu, q, r, u;
  contact::PatchCache patches;
  IslandScratch islands;
  std::unique_ptr<BroadPhase> broad_phase;  // null where every pair is looked at
  SolveResult solve;
  SleepScratch sleep;
  StageClock* clock = nullptr;  // set it to have the stages timed; null costs nothing
};

// f(contact) for all contacts of the last tick, those of islands that sleep after the others.
template <class F>
void forEachContact(const WorldScratch& scratch, F f) {
  for (const Contact& c : scratch.contacts) f(c);
  for (const SleepingContact& c : scratch.sleep.contacts) f(c.contact);
}
inline int contactCount(const WorldScratch& scratch) { return static_cast<int>(scratch.contacts.size() + scratch.sleep.contacts.size()); }

inline const MoverScratch& mover(const WorldScratch& scratch, const Side& side) {
  if (side.kind == SideKind::kPoint) return scratch.points[side.index];
  return scratch.bodies[side.index];
}

// Row k >= kTorsionRow turns about this axis; the radius makes it a velocity.
inline Vec3 axisOf(const Contact& c, int k) { return k == kTorsionRow ? c.R_WC.col(2) : c.R_WC.col(k - kRollingRow); }
inline double radiusOf(const Contact& c, int k) { return k == kTorsionRow ? c.material.torsion_radius : c.material.rolling_radius; }

inline bool turns(const Motion& m) { return m.w_W.squaredNorm() != 0; }

// Adds w x arm.
[[gnu::always_inline]] inline void addTurn(const Vec3& w_W, const Vec3& arm_W, double sign, double (&v_W)[3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    v_W[i] += sign * (w_W[j] * arm_W[k] - w_W[k] * arm_W[j]);
  }
}

// Velocity of a relative to b where they touch, in C: along t1, t2, n [m/s]; of rows that the contact has, about n, t1, t2 [rad/s].
//   rows  of the contact, from withRows
// In line and number by number, here and where it is used: vectors that go through memory are read whole before their halves are there.
template <class Rows>
[[gnu::always_inline]] inline void relativeVelocity(const Contact& c, const Motion& a, const Motion& b, Rows rows, double* v) {
  double v_W[3];
  for (int i = 0; i < 3; ++i) v_W[i] = a.v_W[i] - b.v_W[i];
  if (turns(a)) addTurn(a.w_W, c.arm_a_W, 1, v_W);
  if (turns(b)) addTurn(b.w_W, c.arm_b_W, -1, v_W);
  for (int k = 0; k < 3; ++k) v[k] = c.R_WC(0, k) * v_W[0] + c.R_WC(1, k) * v_W[1] + c.R_WC(2, k) * v_W[2];
  for (int k = kTorsionRow; k < rows; ++k) v[k] = axisOf(c, k).dot(a.w_W - b.w_W);
}

inline void mark(WorldScratch& scratch, Stage stage) {
  if (scratch.clock) scratch.clock->mark(stage);
}

// Identity of a contact from tick to tick; contacts are sorted by it.
//   kind 0: bodies (a, b, feature);  kind 1: point a on body b (feature)
std::uint64_t contactId(int kind, int a, int b, std::uint32_t feature);

// The place of a further contact with gap `phi`, for the caller to fill in: a contact is too large to copy. When all are taken,
// `contacts_dropped` is set and the shallowest makes room; null if that is the new one.
Contact* addContact(WorldScratch& scratch, double phi);

}  // namespace pincer::engine
