// squeeze: walls that don't give way and close on what is between them.
//
//   r_n > kLargestSqueeze M v    for some contact
//   M  the inertia of the heaviest mover, in the direction in which it moves most [kg]
//   v  the speeds of the problem (residual.h)
//
// Jaws with a given motion that close on a rigid body, or a body put where two walls overlap it, have no answer: no
// velocity obeys both. Impulses of the iterates cancel each other and grow without end, and a residual relative to them
// (contactResidual) ends within any tolerance. Bounded answers don't come near the bound: walls squeeze by 1 / sin of
// half the angle between them, a stack by the number of its bodies.
#pragma once
#include <vector>

#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

constexpr double kLargestSqueeze = 1e5;  // a wedge of a thousandth of a degree

// e over w of contacts that are soft [-]: decades, chosen; the first with which Newton's method gets there counts.
constexpr double kSoftestEpsilon = 0.1, kSoftEpsilons[] = {1e-3, 1e-2, kSoftestEpsilon};

// True if the impulses `r` squeeze like that. `weight`: of the contacts, weighContacts (residual.h).
bool isSqueezed(const ContactProblem& problem, const std::vector<double>& weight, const double* r);

}  // namespace pincer::engine
