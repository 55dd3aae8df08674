// step: one tick of the world.
//
//   1 predict         mid-tick poses, velocities that the tick would end with if nothing touched
//   2 collideBodies   contacts between bodies, at the mid-tick poses
//   (3 a caller with points adds their contacts: grasp/step.cpp)
//   4 solveContacts   one coupled solve: rigid contacts and compliant points
//   5 gatherImpulses  contact impulses to bodies and points
//   6 advance         impulses to momenta, momenta to poses
//
// Where bodies hit each other the tick is cut: 1 to 6 up to the hit, the hit, which takes no time (impact.h), 1 to 6 for what is left. Each
// part is a tick of its own length scratch.h, towards targets on the way to those of the whole tick. With options.position_tolerance the tick
// is cut into as many equal parts as that needs, judged by doing it again in twice as many (decision 13).
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

// What happened that a caller may have to know; each bit says what was dropped and what to change.
enum StepStatus : std::uint32_t {
  kStepOk = 0,
  kSolverNotConverged =
      1u << 0,  // impulses are the best iterate, energy-safe. Loosen solver.tolerance, or look for contacts that contradict each other
  kContactsDropped = 1u << 1,  // more contacts than options.max_contacts: the shallowest were dropped. Raise max_contacts
  kStateNotFinite = 1u << 2,   // a NaN or infinity came out of the tick; the state isn't to be used any more. Restore a snapshot
  kInputNotFinite = 1u << 3,   // a target, motion or force wasn't finite; the point kept its last target, the body its place
  kImpactsCut = 1u << 4,       // more impacts than kMostImpacts in one tick: the rest landed. Shorten the tick
  kBudgetSpent =
      1u << 6,  // solver.budget ran out: the tick isn't cut any more, impulses are the best iterate. Raise it, or simplify the scene
  kToleranceNotMet = 1u << 5,  // max_parts were too few for position_tolerance. Raise it, or the tolerance
};

struct StepReport {
  std::uint32_t status = kStepOk;
  int contacts = 0;     // in the last part of the tick
  SolveResult solve;    // likewise
  int parts = 1;        // that the tick was cut into
  bool asleep = false;  // the tick repeats the last one (rest.h); scratch holds its contacts
};

// Finds contacts that the engine doesn't know of, those of driven points: adds them to scratch.contacts (addContact) at the poses in `scratch`.
// Called once for each part of a tick, and for each impact.
class ContactSource {
 public:
  virtual void addContacts(WorldScratch& scratch) = 0;
  // Whether it would add what it added to the last tick, from the same state and inputs.
  virtual bool repeatsItself() const { return true; }

 protected:
  ~ContactSource() = default;
};

// What the caller asks for at the end of the tick.
struct StepInputs {
  std::span<const PointInput> points{};    // one per point
  std::span<const MotionInput> motions{};  // one per driven body, in the order of the bodies; missing ones rest where they are
};

// The stages. scratch.h, scratch.point_inputs and motion_inputs say how long this part of the tick is and where it leads.
void predict(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void predictImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch);  // the same where no time passes
void collideBodies(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void solveContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void gatherImpulses(const WorldModel& model, WorldScratch& scratch);
void advance(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// One tick: all of the above. `source` may be null: then points touch nothing. Allocates nothing.
StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs = {},
                ContactSource* source = nullptr);
inline StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, std::span<const PointInput> points) {
  return step(model, state, scratch, StepInputs{points, {}});
}

}  // namespace pincer::engine
