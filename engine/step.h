// step: one tick of the world: contacts, forces and motion, all from one coupled solve
// (docs/engine.md; its stages: engine/world/stages.h).
//
//   auto scratch = makeScratch(model);
//   StepReport report = step(model, state, *scratch, inputs);
//   report.status is kStepOk,  contactAt(*scratch, k) says what touched
//
// Where bodies hit each other the tick is cut: up to the hit, the hit, which takes no time, and what is left. With
// options.position_tolerance it is cut into as many equal parts as that needs.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "pincer/engine/model.h"
#include "pincer/engine/motion.h"
#include "pincer/engine/solver.h"
#include "pincer/engine/state.h"

namespace pincer::engine {

// Motion of a driven body at the end of the tick: pose of its frame B, velocity of B's origin, angular velocity.
using MotionInput = DrivenPlace;

// Where a driven point's target is at the end of the tick, and a force on the point over the tick.
struct PointInput {
  Vec3 p_target_W = Vec3::Zero();  // [m]
  Vec3 v_target_W = Vec3::Zero();  // [m/s]
  Vec3 f_W = Vec3::Zero();         // [N]
  Vec3 w_W = Vec3::Zero();         // with which what the point stands for turns, over the tick [rad/s]
  // Axes A of the coupling where they aren't the world's: frameFromNormal of this unit
  // vector, the axis of its twist (contact/math.h).
  bool turned = false;
  Vec3 n_W = Vec3::UnitZ();
};

// A push on a body over the tick: a force through its centre of mass, and a torque.
struct BodyForce {
  Vec3 f_W = Vec3::Zero();    // [N]
  Vec3 tau_W = Vec3::Zero();  // [N m]
};

// Loads on bodies besides contacts and joints, the same all through the tick.
struct AppliedForces {
  std::span<const BodyForce> forces{};  // one per body, or none; those of static and driven bodies do nothing
  std::optional<Vec3> gravity_W{};      // in place of WorldOptions::gravity_W [m/s^2]
};

// Motions and loads that the caller asks for at the end of the tick.
struct StepInputs {
  std::span<const PointInput> points{};  // one per point
  // one per driven body, in the order of the bodies; missing ones rest where they are
  std::span<const MotionInput> motions{};
  AppliedForces applied{};
  std::span<const DriveInput> controls{};  // one per drive; missing ones stay as they were
};

// Events that a caller may have to know; each bit says what was dropped and what to change.
enum StepStatus : std::uint32_t {
  kStepOk = 0,
  // impulses are the best iterate, energy-safe. Loosen solver.tolerance, or
  // look for contacts that contradict each other
  kSolverNotConverged = 1u << 0,
  // more contacts than options.max_contacts: the shallowest were dropped. Raise max_contacts, or growContacts
  kContactsDropped = 1u << 1,
  // a NaN or infinity came out of the tick; the state isn't to be used any more. Restore a snapshot
  kStateNotFinite = 1u << 2,
  // a target, motion or force wasn't finite; the point kept its last target,
  // the body its place, no force on bodies acts
  kInputNotFinite = 1u << 3,
  kImpactsCut = 1u << 4,       // more impacts than kMostImpacts in one tick: the rest landed. Shorten the tick
  kToleranceNotMet = 1u << 5,  // max_parts were too few for position_tolerance. Raise it, or the tolerance
  // solver.budget ran out: the tick isn't cut any more, impulses are the best iterate. Raise it, or simplify the scene
  kBudgetSpent = 1u << 6,
  // A joint of a tree turns by more than half a radian in a 64th of the tick, or what is driven pushes a body almost
  // through its axis (world/budget.h): its energy is bounded, its course isn't exact. Shorten the tick
  kTurnsTooFar = 1u << 7,
};

struct StepReport {
  std::uint32_t status = kStepOk;
  int contacts = 0;     // in the last part of the tick
  SolveResult solve;    // likewise
  int parts = 1;        // that the tick was cut into
  bool asleep = false;  // the tick repeats the last one, and so do its contacts
};

// Working memory of a step, sized once from the model: no result depends on what the last tick left in it. One thread
// at a time; several states may be stepped with one, and many threads may step one model, each with its own.
struct WorldScratch;
struct DeleteScratch {
  void operator()(WorldScratch* scratch) const;
};
using ScratchHandle = std::unique_ptr<WorldScratch, DeleteScratch>;

ScratchHandle makeScratch(const WorldModel& model);

// One tick. Driven points touch nothing here: fingers do (grasp/step.h). Allocates nothing, throws nothing.
StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs = {});
inline StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch,
                       std::span<const PointInput> points) {
  return step(model, state, scratch, StepInputs{points, {}});
}

// A place where two touch, as the last part of the last tick left it. `body` is
// touched by another body or by a driven point.
struct ContactReport {
  std::uint64_t id = 0;          // the same from tick to tick for as long as the two touch there
  int point = -1;                // that touches, -1: a body does
  int other_body = -1;           // that touches, -1: a point does
  int body = -1;                 // that is touched
  int shape = 0;                 // of its shapes, the one that is touched
  int other_shape = 0;           // of those of `other_body`, the one that touches
  Vec3 p_W = Vec3::Zero();       // where [m]
  Vec3 n_W = Vec3::UnitZ();      // out of `body`
  double gap = 0;                // in the middle of the tick [m], negative: overlap
  Vec3 f_W = Vec3::Zero();       // on what touches; `body` feels exactly the negative [N]
  Vec3 moment_W = Vec3::Zero();  // of torsion and rolling friction on what touches, about p_W [N m]
  double mu = 0;                 // friction coefficient in force [-]
  bool pushes = false;           // false: near, but without a force
  bool sliding = false;
};

// Load on a joint in the last tick, its mean over it [N, N m]; along its coordinate.
struct JointReport {
  double stop_force = 0;      // of its limits
  double friction_force = 0;  // of its dry friction
  bool at_lower = false, at_upper = false;
};
// All that a joint passes on to its body a: stops, drives, friction, and what it blocks.
struct JointLoad {
  Vec3 f_J = Vec3::Zero();       // [N], in the axes of its frame J on a
  Vec3 moment_J = Vec3::Zero();  // about J [N m]
};
struct DriveReport {
  double force = 0;  // along l
  bool saturated = false;
};
// `joint` and `drive` as the builder numbered them.
JointReport jointAt(const WorldModel& model, const WorldScratch& scratch, int joint);
DriveReport driveAt(const WorldScratch& scratch, int drive);
// Its mean over the last part of the last tick, after which `state` is; `applied`: the forces of that tick, as given to
// step. Not a number of a joint that is part of a loop, whose share nothing tells.
JointLoad jointLoadAt(const WorldModel& model, const WorldState& state, const WorldScratch& scratch, int joint,
                      const AppliedForces& applied = {});

// Contacts of the last tick, sorted by id but for those of what sleeps, which come last.
int contactCount(const WorldScratch& scratch);
ContactReport contactAt(const WorldScratch& scratch, int k);  // 0 <= k < contactCount

}  // namespace pincer::engine
