// search: the impulses of many contacts, by sweeps, descents and rounds (contact_solver.h).
//
// Never throws, allocates or prints; deterministic.
#pragma once
#include "pincer/engine/solve/solver_scratch.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

// From `r`, in the cones, or from none where that is nearer; where `r` squeezes (squeeze.h), from none, as if contacts
// were soft, with the shift of no impulse. `r`, `u` and the result as those of solveContacts, but that unsolved
// impulses may add energy.
SolveResult searchImpulses(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch,
                           double* r, double* u);

}  // namespace pincer::engine
