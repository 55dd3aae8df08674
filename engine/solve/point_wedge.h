// point_wedge: one mover that doesn't turn (a fingertip), which slides on two walls at once: a root in one unknown.
//
//   u_in = 0:          y = y_0 + s e,           e = a_0 x a_1 / |a_0 x a_1|,   a_i = A_i^T e_n
//   slide:             r_i = rho_i (e_n - mu_i u_iT / |u_iT|),                 u_iT = A_iT (y_0 + s e) + q_iT
//   y = A^T r:         y_0 + s e = rho_0 g_0(s) + rho_1 g_1(s),                g_i = a_i - mu_i A_iT^T u_iT / |u_iT|
//   so                 f(s) = det(g_0, g_1, y_0 + s e) = 0,                    rho_i >= 0 from two of the three equations
//
//   y, A, q as in contact_problem.h, the three freedoms that a point has; s along the groove [sqrt(J)]
// Where walls ask for velocities that contradict each other by some um/s (one that lands while the other sticks), both slide by no more than that, and
// the direction of friction is decided by it: Newton's method stalls at residuals of 1e-6. f turns where the u_iT are least, by their size there: it is
// looked at in steps that grow from there, and its roots are closed in by halving.
#pragma once
#include "engine/solve/contact_problem.h"

namespace pincer::engine {

// Whether `problem` is of that kind: two contacts of three rows with friction, one mover that doesn't turn.
bool isPointWedge(const ContactProblem& problem);

// Impulses with which both contacts slide, if there are any with rho_i >= 0; of several the one with the least |s|. False, and r as before, if there are none.
bool slideInWedge(const ContactProblem& problem, VectorMap r);

}  // namespace pincer::engine
