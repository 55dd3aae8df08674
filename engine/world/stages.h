// stages: one tick of the world, stage by stage.
//
//   1 predict         mid-tick poses, velocities that the tick would end with if nothing touched
//   2 collideBodies   contacts between bodies, at the mid-tick poses
//   (3 a caller with points adds their contacts: ContactSource)
//   4 prepareContacts what each contact remembers and asks for (contact_rows.h)
//     solveContacts   one coupled solve: rigid contacts and compliant points
//   5 gatherImpulses  contact impulses to bodies and points
//   6 advance         impulses to momenta, momenta to poses
//
// Where bodies hit each other the tick is cut: 1 to 6 up to the hit, the hit, which takes no time (impact.h), 1 to 6
// for what is left. Each part is a tick of its own length scratch.h, towards targets on the way to those of the
// whole tick. With options.position_tolerance the tick is cut into as many equal parts as that needs, judged by
// doing it again in twice as many (decision 13).
//
// Second order in the tick while contacts persist: geometry at the predicted middle, p += h (v + v+)/2; a contact that
// closes in this tick lands exactly, p += h v+. (docs/decisions/0003-second-order-contact.md)
#pragma once
#include "pincer/engine/step.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// Finds contacts that the engine doesn't know of, those of driven points: adds them to scratch.contacts (addContact) at
// the poses in `scratch`. Called once for each part of a tick, and for each impact.
class ContactSource {
 public:
  virtual void addContacts(WorldScratch& scratch) = 0;
  // True if it would add what it added to the last tick, from the same state and inputs.
  virtual bool repeatsItself() const { return true; }

 protected:
  ~ContactSource() = default;
};

// The stages. scratch.h, scratch.point_inputs and motion_inputs say how long
// this part of the tick is and where it leads.
void predict(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
// the same where no time passes
void predictImpact(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void collideBodies(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void prepareContacts(const WorldModel& model, const WorldState& state, WorldScratch& scratch);
void solveContacts(const WorldModel& model, WorldScratch& scratch);
void gatherImpulses(const WorldModel& model, WorldScratch& scratch);
void advance(const WorldModel& model, WorldState& state, WorldScratch& scratch);

// One tick: all of the above. `source` may be null: then points touch nothing. Allocates nothing.
StepReport step(const WorldModel& model, WorldState& state, WorldScratch& scratch, const StepInputs& inputs,
                ContactSource* source);

}  // namespace pincer::engine
