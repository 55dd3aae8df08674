// newton: semi-smooth Newton on Alart and Curnier's equations.
//
//   Phi_n = r_n - max(0, y_n),   Phi_T = r_T - P_disc(mu max(0, y_n))(y_T),   y = r - rho u,   rho = 1 in scaled variables
//   ((I - D) + D W^ + epsilon I) dr = -Phi,   D = dP/dy,   r <- P_K(r + t dr)
//
// epsilon is a proximal term: it leaves the solution alone and picks the smallest step among the many of redundant contacts (a box on four
// corners). A contact that is open and carries nothing drops out of the equations.
// Sources: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353-375; line search and comparison of variants: V. Acary,
// M. Bremond, O. Huber, in Advanced Topics in Nonsmooth Dynamics (2018) 375-457. Departure: each iterate is put back into the cones, so
// that any of them may be returned.
#pragma once
#include "engine/solve/scaled_problem.h"

namespace pincer::engine {

// Up to `iterations` steps from `current` (evaluated) until its residual is within `tolerance`; `trial` is working memory. Swaps the two as it
// goes; `current` is the last iterate on return. Returns the number of steps.
int iterateNewton(const ScaledProblem& problem, double tolerance, int iterations, SolverScratch& scratch, Iterate& current, Iterate& trial);

}  // namespace pincer::engine
