// session_checks: what must hold of the session out/session.db of a case, whatever happened to the program
// that wrote it (inputs.h: pickupArguments).
#pragma once
#include "pincer/tests/campaign/row.h"
#include "pincer/tests/campaign/session_file.h"

namespace pincer::campaign {

// Everything in `before` is still there, unchanged; nothing stands there twice.
void compareTrials(Case& c, const SessionState& before, const SessionState& after);

// Complete, with the trials of an undisturbed session and no others.
void requireWhole(Case& c);

// Goes on with the session, or begins again what was never made; then it must be whole, and
// what was finished must be there as it was.
void completeSession(Case& c);

}  // namespace pincer::campaign
