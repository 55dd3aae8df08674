#include "engine/solve/large_problem.h"

#include <algorithm>

#include "engine/solve/gauss_seidel.h"
#include "engine/solve/residual.h"

namespace pincer::engine {
namespace {

constexpr int kSweptVisits = 12000;  // of contacts in a tick, some 0.8 ms: 40 sweeps of the heap of 100 balls, 4 of one of 1000
constexpr int kFewestSweeps = 4, kMostSweeps = 40;  // sweeps
constexpr int kRestingSweeps = 2;                   // sweeps of what was near enough before them: so a heap comes to rest
constexpr int kBetweenLooks = 4;                    // a look at the residual costs half a sweep

}  // namespace

SolveResult solveLargeProblem(const ContactProblem& problem, double enough, double start, SolverScratch& scratch, double* r, double* u) {
  const int n = problem.contactCount();
  const int most = start <= enough ? kRestingSweeps : std::clamp(kSweptVisits / n, kFewestSweeps, kMostSweeps);
  GaussSeidel method({problem.first_row, problem.mu, problem.sides, problem.q.data(), scratch.y.data(), problem.movers}, scratch, r);
  double residual = start;
  int sweeps = 0;
  while (sweeps < most) {
    const bool is_spent = !spend(kPerContactSwept * n, scratch);
    method.sweep(sweeps++ % 2 == 1);
    if (sweeps == most || (is_spent && sweeps >= kFewestSweeps)) break;  // contacts that are new have no impulse yet: every tick gets a few
    if (sweeps % kBetweenLooks == 0) {
      residual = weighedResidual(problem, r, scratch, u);
      if (residual <= enough) break;
    }
    method.accelerate();
  }
  residual = weighedResidual(problem, r, scratch, u);
  const bool converged = residual <= enough;
  return {converged ? SolveMethod::kGaussSeidel : SolveMethod::kNotConverged, sweeps, residual, start, converged};
}

}  // namespace pincer::engine
