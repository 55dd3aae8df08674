// point_problem: one mover that doesn't turn (a fingertip) at up to four walls: each set of
// walls that may push it is tried on its own.
//
//   one wall      sticks or slides: the exact solution of local_contact.h
//   slides on two     u_in = 0:       y = y_0 + s e,           e = a_0 x a_1 / |a_0 x a_1|,   a_i = A_i^T e_n
//                     friction:       r_i = rho_i (e_n - mu_i u_iT / |u_iT|),
//                                     u_iT = A_iT (y_0 + s e) + q_iT
//                     y = A^T r:      y_0 + s e = rho_0 g_0(s) + rho_1 g_1(s),
//                                     g_i = a_i - mu_i A_iT^T u_iT / |u_iT|
//                     so              f(s) = det(g_0, g_1, y_0 + s e) = 0,
//                                     rho_i >= 0 from two of the three equations
//   slides on three   u_in = 0 gives y, with it the g_i, and  rho_0 g_0 + rho_1 g_1 + rho_2 g_2 = y
//
//   y, A, q as in contact_problem.h, the three freedoms that a point has; s along the groove [sqrt(J)]
// Walls at two of which it sticks, or sticks to one and slides on another, ask for the same velocity; those Newton's
// method finds. Where walls ask for velocities that contradict each other by some um/s (one that lands while the other
// sticks), it slides on both by no more than that, or rests on one alone; the direction of friction is decided by it,
// and Newton's method stalls at residuals of 1e-6. f turns where the u_iT are least, by their size there: it is looked
// at in steps that grow from there, and its roots are closed in by halving. In a groove that locks (wedge.h)
// contradictions may leave no answer at all.
#pragma once
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

// True if `problem` is of that kind: two to four contacts of three rows, one mover that doesn't turn.
bool isPointProblem(const ContactProblem& problem);

// Impulses with a residual of no more than `enough`, and their velocities; `residual` is theirs. The contacts are
// weighed (residual.h). False, and all as before, if there are none.
bool solvePointProblem(const ContactProblem& problem, double enough, SolverScratch& scratch, double* r, double* u,
                       double& residual);

}  // namespace pincer::engine
