// gauss_seidel: projected Gauss-Seidel with an exact solution per contact (local_contact.h).
//
// Slow where contacts are redundant or masses differ, but it hardly ever fails to improve: it carries Newton's method to where that converges.
// Source: M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257 (non-smooth contact dynamics).
#pragma once
#include "engine/solve/scaled_problem.h"

namespace pincer::engine {

constexpr std::int64_t kPerContactSwept = 250;  // multiplications of a sweep

// Fills scratch.terms with what the sweeps need of each contact; they stay right until Newton's method or the interior point uses `scratch`.
void prepareGaussSeidel(const ScaledProblem& problem, SolverScratch& scratch);

// `sweeps` passes over all contacts, in order, each at a cost linear in their number. `it` is evaluated on return.
void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, SolverScratch& scratch, Iterate& it);

}  // namespace pincer::engine
