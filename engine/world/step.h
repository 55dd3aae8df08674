// step: one tick of the world.
//
//   1 predict        mid-tick poses, velocities that the tick would end with if nothing touched
//   2 collideBodies  contacts between bodies, at the mid-tick poses
//   (3 a caller with points adds their contacts: grasp/step.cpp)
//   4 solveContacts  one coupled solve: rigid contacts and compliant points
//   5 advance        impulses to momenta, momenta to poses
//
// Second order in the tick while contacts persist: geometry at the predicted middle, p += h (v + v+)/2; a contact that closes in this tick
// lands exactly, p += h v+. (docs/decisions/0003-second-order-contact.md)
#pragma once
#include <cstdint>
#include <span>

#include "engine/world/model.h"
#include "engine/world/scratch.h"
#include "engine/world/state.h"

namespace pincer::engine {

// Where a driven point's target is at the end of the tick, and a force on the point over the tick.
struct PointInput {
  Vec3 p_target_W = Vec3::Zero();  // [m]
  Vec3 v_target_W = Vec3::Zero();  // [m/s]
  Vec3 f_W = Vec3::Zero();         // [N]
};

// What happened that a caller may have to know; each bit says what was dropped and what to change.
enum StepStatus : std::uint32_t {
  kStepOk = 0,
  kSolverNotConverged =
      1u << 0,  // impulses are the best iterate, energy-safe. Loosen solver.tolerance, or look for contacts that contradict each other
  kContactsDropped = 1u << 1,  // more contacts than options.max_contacts: the shallowest were dropped. Raise max_contacts
  kStateNotFinite = 1u << 2,   // a NaN or infinity came out of the tick; the state isn't to be used any more. Restore a snapshot
  kInputNotFinite = 1u << 3,   // a target or force wasn't finite; the point kept its last target
};

struct StepReport {
  std::uint32_t status = kStepOk;
  int contacts = 0;
  SolveResult solve;
};

void predict(const WorldModel& model, const WorldState& state, std::span<const PointInput> inputs, WorldScratch& scratch);
void collideBodies(const WorldModel& model, WorldScratch& scratch);
void solveContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
StepReport advance(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// All of the above: for worlds whose points touch nothing. `inputs` has one entry per point. Allocates nothing.
StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, std::span<const PointInput> inputs = {});

}  // namespace pincer::engine
