// few_contacts: up to kFewContacts contacts, to the tolerance, cheapest method first.
//
//   Newton's method (newton.h)
//   a short search (search.h), which finds most of what that misses for a tenth of what an interior point costs
//   an interior point, Newton's method and a short search from where it ends (interior_point.h)
//   contacts give way, if they may
//   a long search
//
// Contacts that slip by 1e-5 of the problem's speeds seem to contradict each other: friction follows the direction of
// the slip, which errors of 1e-6 turn. The interior point goes down to 1e-12, by equations contact by contact.
// A point between walls, if all that failed, goes to point_problem.h. Decision 20 says why the interior point stays.
//
// Never throws, allocates or prints; deterministic.
#pragma once
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

struct SolverScratch;
// Fewer are solved from the interior before they give way: bodies that are pinched must not creep.
constexpr int kManyContacts = 12;
constexpr int kFewContacts = 60;    // beyond, what needs many factorisations costs milliseconds
constexpr int kDenseContacts = 40;  // beyond, a dense matrix costs more than any graph of movers that fits

// Solves `problem`, of at most kFewContacts, its contacts weighed (residual.h), from `r` (in the cones), whose
// velocities are `u` and whose residual is `start`; as solveContacts.
void solveFewContacts(const ContactProblem& problem, const SolverOptions& options, double start, SolverScratch& scratch,
                      double* r, double* u, SolveResult& result);

}  // namespace pincer::engine
