// far_contacts: contacts that can't close within this part of the tick aren't solved: they would cost time, tie islands
// together, and blur what residuals are relative to.
//
//   phi_0 / h + n . v_free > v      v  the fastest free motion of all that contacts link, open or not, and
//                                      kFarTimes that of the two [m/s]
//
// Their staying open is looked at after the solve; where one doesn't, it is solved with the others after
// all. So the answer is that of all contacts.
#pragma once
#include "pincer/engine/model.h"
#include "pincer/engine/world/scratch.h"

namespace pincer::engine {

// After the contacts were filled.
void markFarContacts(const WorldModel& model, WorldScratch& scratch);

// Call gatherImpulses before. Fills u_C of far contacts. True if some close in spite of all: they aren't far any
// more, and everything is to be solved again.
bool haveFarClosed(const WorldModel& model, WorldScratch& scratch);

}  // namespace pincer::engine
