// interior_point: a primal-dual interior-point method for the frictional contact
// problem, for where Newton's method finds no way.
//
//   x = (r_T, mu r_n),  z = (u_T, u_n / mu + |u_T|),   both in the Lorentz cone
//   x o z = sigma e -> 0   (o: the cone's Jordan product)
//   (N^2 + (I + e_n t^T) S W^ S) dx = N (lambda \ c) + z - z(x),   t = u_T / |u_T|,   S = diag(1, 1, 1 / mu[, 1 ..])
//
// with Nesterov-Todd's scaling N: N x = N^-1 z = lambda, and Mehrotra's predictor and corrector. The shift |u_T| is
// part of z and of its derivative, so that the fixed point is the true, non-convex law and not its convex relaxation.
// Sources: L. Vandenberghe, "The CVXOPT linear and quadratic cone program solvers" (2010); the shift: V. Acary, P.
// Armand, H. M. Nguyen, M. Shpakovych, Optim. Methods Softw. 39 (2024).
#pragma once
#include "pincer/engine/solve/contact_equations.h"

namespace pincer::engine {

constexpr int kInteriorPointVectors = 8;  // of working memory in SolverScratch::workspace

// From a point well inside the cones, up to `iterations` steps towards the solution, until residual or gap and defect
// are within `tolerance`. Fills and evaluates `current`; returns the number of steps. It comes close to where solutions
// are, not within 1e-10 of them: Newton's method follows.
int followCentralPath(const ScaledProblem& problem, double tolerance, int iterations, ContactEquations& equations,
                      SolverScratch& scratch, Iterate& current);

}  // namespace pincer::engine
