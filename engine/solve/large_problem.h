// large_problem: contacts that are too many and too entangled for Newton's method (heaps of some hundred), by accelerated Gauss-Seidel.
//
// A few sweeps per tick from the last tick's impulses: what a tick leaves undone the next one goes on with. Anytime: the work is bounded
// by visits to contacts, so that a tick of a thousand bodies costs little more than one of a hundred. A heap of hundreds that falls is solved as
// far as that goes, and flagged where that isn't to kLargeSpeed; one of a hundred, or that settles, is.
#pragma once
#include "pincer/engine/solve/cascade.h"

namespace pincer::engine {

// What is enough: a hundredth of what gravity adds in a tick of 1 ms, 0.1 um per tick [m/s].
constexpr double kLargeSpeed = 1e-4;

// Solves `problem`, weighed, to the residual `enough` or as far as the sweeps go, with warm start r, its velocities u, scratch.y = A^T r and
// residual `start`; r and u on return are those of the last sweep.
SolveResult solveLargeProblem(const ContactProblem& problem, double enough, double start, SolverScratch& scratch, double* r, double* u);

}  // namespace pincer::engine
