// contact_solver: solves a ContactProblem, of any size, by one equation and one number for its error.
//
//   u = W r + q + e (r - r_c),   r and u in Coulomb's law with exact cones,   e_i = epsilon w_i
//   r_c moves to r until |e (r - r_c)| is small enough
//
//   look at the warm start; good enough? done
//   all below: however many movers a contact has, as links of long arms do
//   up to three contacts of one to three movers   Newton's method, with all sizes known
//                                                 to the compiler (small_problem.h)
//   up to kFewContacts, all stick or are open      stuck_contacts.h, in one step
//   up to kFewContacts                            Newton's method, then as if they were more, with
//                                                 an interior point in between (few_contacts.h)
//   between balls, or the movers' matrix doesn't factorise cheaply (heaps)   sweeps.h
//   more                                          far: what slides by sweeps, then rounds with a frozen
//                                                 shift (descents);  near: rounds, epsilon by how easily
//                                                 the last one went; one that fails: the former again, and
//                                                 five times the epsilon (proximal_round.h)
//   spent, or no nearer                           the best iterate, in the cones, scaled so
//                                                 that it adds no energy, with its error
//
// The give e (r - r_c) is the error [m/s]. Where contacts contradict each other it doesn't vanish, and is the least
// that they have to give way by; where it is large walls close on what is between them (squeeze.h): then contacts are
// soft, epsilon r, about no impulse at all.
//
// Enough is the tolerance, and of more than kFewContacts: options.accuracy, or kShareOfSlip of the fastest slip of what
// pushes [m/s]; a looser accuracy than the default counts up to kShareOfSlow of that slip; a hundred times the default
// where all is swept. Below it a heap that still moves isn't solved further; one that is quiet is, to round-off, or at
// a looser accuracy to restErrorOf, so that it comes to rest.
//
// A body that has come to rest under impulses that are off by less than the tolerance drifts until they
// aren't, then is put right, in a cycle without end. So after an answer that took iterations the next ones
// are `strict`: a warm start must be exact to round-off, until it is clear that none comes (engine/world).
// A body at rest then needs no iteration any more.
//
// Never throws, allocates or prints; deterministic.
#pragma once
#include "pincer/engine/solve/solver_scratch.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

// A contact that moves slower than this, of more than kDenseContacts, is at rest [m/s]: with
// the default accuracy a millimetre in a day.
inline double restErrorOf(const SolverOptions& options) { return 0.01 * options.accuracy; }

// Solves `problem`. `r` holds the warm start on entry (zeros are fine) and the impulses on return: in the cones
// to 1e-12 relative, whatever happened. `u` receives the contact velocities. Nothing is copied here: copies wait
// until what they are of is written to its last byte. Where result.give isn't 0, scratch.give holds what each
// row gave way by [m/s], and u contains it.
void solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, double* r,
                   double* u, SolveResult& result);
inline SolveResult solveContacts(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch,
                                 VectorMap r, VectorMap u) {
  SolveResult result;
  solveContacts(problem, options, scratch, r.data(), u.data(), result);
  return result;
}

// True if a calm problem's warm start `r`, in the cones, is as good as rest asks for: then u and `result` are its.
// Where it is, what contacts ask for needn't be made consistent, and stays what it was, to the bit.
bool restsAsItIs(const ContactProblem& problem, const SolverOptions& options, SolverScratch& scratch, const double* r,
                 double* u, SolveResult& result);

// The relative natural-map residual of `r` (residual.h); `u` receives W r + q.
double contactResidual(const ContactProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& r,
                       SolverScratch& scratch, Eigen::Ref<Eigen::VectorXd> u);

// Impulses that stop what closes, by `sweeps` from those in `r`, in the cones. For a problem without an answer, from
// none: the iterate with the least residual may there be no impulse at all. They bring no energy in, wherever they end;
// the budget may end them sooner. `u` as above.
void stopBySweeps(const ContactProblem& problem, int sweeps, SolverScratch& scratch, VectorMap r, VectorMap u);

}  // namespace pincer::engine
