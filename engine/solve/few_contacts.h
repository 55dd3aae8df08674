// few_contacts: up to kFewContacts contacts, to the tolerance, cheapest method first.
//
//   semi-smooth Newton (Alart-Curnier) -> interior point, then Newton with a proximal term -> projected Gauss-Seidel
//   with exact local solves -> best iterate, from which search.h goes on.
//   Newton's method finishes what the others begin.
// Of a dozen contacts and more the proximal term comes first, for an interior point costs as much as all else.
//
// Contacts that slip by 1e-5 of the problem's speeds seem to contradict each other: friction follows the direction of
// the slip, which errors of 1e-6 turn. The interior point goes down to 1e-12, by equations contact by contact, and the
// proximal term is as small as that slip asks for. What fails then gives way, if it may.
// A point between walls, if all else failed, goes to point_problem.h. Decision 4 says why these stay:
// from no impulse at all they solve what the search doesn't (contacts on which almost everything slides,
// of mass ratios of a thousand), to 1e-10.
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

// Solves `problem`, of at most kFewContacts, from `r` (in the cones) whose velocities `u` and residual `start` are; as
// solveContacts, but that impulses may squeeze (squeeze.h) where soft contacts weren't solved; result.yields.
void solveFewContacts(const ContactProblem& problem, const SolverOptions& options, double start, SolverScratch& scratch,
                      double* r, double* u, SolveResult& result);

}  // namespace pincer::engine
