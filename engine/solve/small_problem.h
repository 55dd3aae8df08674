// small_problem: Newton's method on Alart and Curnier's equations for one to three contacts of three or four rows, the
// usual grasps, with all sizes known to the compiler.
//
//   u = W r + q,   y_i = w_i r_i - u_i,   w_i the mean of W_ii's diagonal
//   open   (y_n <= 0)              dr_i = -r_i
//   stick  (|y_T| <= mu y_n)       (W dr)_i = -u_i
//   slide                          w_i (I - D) dr_i + D (W dr)_i = -(w_i r_T - s y_T, u_n)
//                                  D as in cone.h's SlideDerivative
//
// W is stored whole, in velocities per impulse: nothing is scaled, and the warm start's residual costs no more
// than by the factors of W. Full steps only; what they don't solve is left to contact_solver.h, from the same
// warm start. Source: as proximal_round.h.
#pragma once
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

// True if that solved `problem`: then r, u and `result` are what solveContacts returns. Else
// r is as before; u isn't meant to be read.
//   r  warm start, in the cones
bool solveSmallProblem(const ContactProblem& problem, const SolverOptions& options, double* r, double* u,
                       SolveResult& result);

}  // namespace pincer::engine
