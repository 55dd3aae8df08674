// stuck_contacts: contacts that all stick, or are open, around a few movers, in one step; more of them than the movers
// can tell apart, as the corners of a pad or of a box.
//
//   minimise |dr|  with  W dr = -u   =>   dr = A N^-2 A^T (-u),   N = A^T A + ridge I
//                                                                 (contact_problem.h: W = A A^T)
//
//   u   velocities at the impulses r; dr what is added to those of the contacts that stick [N s]
//   N   one 6 x 6 block per mover that turns, 3 x 3 per point; points never touch
//       each other, and are eliminated first (Schur)
//
// Of all impulses that hold the bodies the step takes those nearest to the warm start: what redundant contacts share
// among them changes by no more than it must. Step by step these changes add up, though, to shares that use friction up
// where none need be used: once a contact holds with more than half of its friction, or one that pushed opens, the step
// declines (a cylinder carried between flat jaws slipped by 2 mm).
//
// Then fingertips that touch with a face share anew: from r = 0 the same step leads to the least impulses of all
// with which everything sticks. They press evenly where others hang all of the load on one end of a face, about
// which the body swings for ever (a rod nudged between flat pads, 6 mm); nothing of what was remains in them.
// Contacts that would pull are let go, one step after the other; corners that contradict each other, as gaps of
// bodies that turn do by the square of the turn, give way by what the least squares leave. The ridge, one for all
// movers, keeps motions that no contact sees out of N's inverse (where it differs from mover to mover they come in);
// what it leaves of -u, some 1e-9 of it, the next step takes.
// Source: G. Golub, C. Van Loan, Matrix Computations, 4th ed. (2013), section 5.5 (least norm).
#pragma once
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

constexpr int kMostStuckSteps = 3;          // each with a set of contacts that hold: a factorisation
constexpr double kStuckFrictionUsed = 0.5;  // at most, for the step to go on with its shares
constexpr double kStuckRidge = 1e-10;       // of N's diagonal: far above round-off, which it meets twice

// Multiplications of a step.
inline std::int64_t stuckOperations(const ContactProblem& problem) {
  constexpr std::int64_t kPerContact = 300, kPerMover = 200;
  return kPerContact * problem.contactCount() + kPerMover * problem.movers;
}

// True if the contacts stick or are open, and that solved `problem`: then r, u and `result` are those of
// solveContacts. Else all three are as before.
//   r       warm start, in the cones;  u  its velocities;  scratch.weight filled
//   result  its error
bool solveStuckContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                        double* u, SolveResult& result);

}  // namespace pincer::engine
