// newton: semi-smooth Newton on Alart and Curnier's equations.
//
//   Phi_n = r_n - max(0, y_n),   Phi_T = r_T - P_disc(mu max(0, y_n))(y_T)
//   y = r - rho u,   rho = 1 in scaled variables
//   ((I - D) + D W^ + epsilon I) dr = -Phi,   D = dP/dy,   r <- P_K(r + t dr)
//
// epsilon is a proximal term: it leaves the solution alone and picks the smallest step among the many of redundant
// contacts (a box on four corners). It is larger where the equations are solved mover by mover, whose round-off is
// that of 1 / epsilon; corrections with the same factors (the proximal-point method's further steps), one and rarely
// two, make up for that. A contact that is open and carries nothing drops out. Sources: P. Alart, A. Curnier,
// Comput. Methods Appl. Mech. Engrg. 92 (1991) 353-375; line search and comparison of variants: V. Acary, M.
// Bremond, O. Huber, in Advanced Topics in Nonsmooth Dynamics (2018) 375-457. Departure: each iterate is put back
// into the cones, so that any of them may be returned.
#pragma once
#include "pincer/engine/solve/contact_equations.h"

namespace pincer::engine {

// Of equations contact by contact, of the W_ii of one: far above round-off, far below what one contact gives.
constexpr double kContactsEpsilon = 1e-11;

// Up to `iterations` steps from `current` (evaluated) until its residual is within `tolerance`; `trial` is working
// memory. Swaps the two as it goes; `current` is the last iterate on return. Gives up early where the residual has
// stopped falling. Returns the number of steps.
int iterateNewton(const ScaledProblem& problem, double tolerance, int iterations, ContactEquations& equations,
                  SolverScratch& scratch, Iterate& current, Iterate& trial);

// For contacts that contradict each other, which have no answer: up to `rounds` problems with the velocities
// u + epsilon (r - r_c), r_c the answer of the round before (R. Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898,
// proximal point). Each is tame, for contacts give way by epsilon. The result is the answer for q + give, give =
// epsilon (r - r_c) of the last round that was solved. It tends to the least that they have to give way by; rounds go
// on until it is at most `largest` [m/s] and no longer fades. scratch.give holds it, unscaled [m/s]; `current`, its u
// with it, is that round's. `largest` becomes the largest of it; infinite, and `current` as before, if no round was
// solved.
int iterateGiving(const ScaledProblem& problem, double tolerance, int rounds, ContactEquations& equations,
                  SolverScratch& scratch, Iterate& current, Iterate& trial, double& largest);

// For contacts that contradict each other by more than any may give way (squeeze.h): the answer where each is
// soft, with the velocities u + epsilon r, from no impulse. It always has one, of impulses 1 / epsilon times what
// stops a body that closes as fast. `current` is that one, its u without epsilon r; false if no epsilon of three
// led to it. `steps` grows by those taken.
bool iterateSoftly(const ScaledProblem& problem, double tolerance, ContactEquations& equations, SolverScratch& scratch,
                   Iterate& current, Iterate& trial, int& steps);

}  // namespace pincer::engine
