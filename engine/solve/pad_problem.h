// pad_problem: stuck_contacts.h's step for the usual grasp by flat pads, up to sixteen contacts of three rows of one
// body with up to four points that don't turn, and with what doesn't move. Contacts lie side by side, two to a
// register, so that a pad's corners cost little more than a sphere's one place.
//
//   y = A^T r,   u = A y + q;   all stick that push:  dr = A N^-2 A^T (-u),  N = A^T A + ridge I
#pragma once
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

// True if `problem` is of that kind, and its warm start or a few steps from there solved it: then r, u and `result` are
// those of solveContacts, by the rules of stuck_contacts.h. Else r is as before, and the other two aren't to be read.
//   r  warm start, in the cones
bool solvePadProblem(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                     double* u, SolveResult& result);

}  // namespace pincer::engine
