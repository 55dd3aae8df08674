#include "pincer/engine/solve/large_problem.h"

#include <algorithm>

#include "pincer/engine/solve/gauss_seidel.h"
#include "pincer/engine/solve/residual.h"

namespace pincer::engine {
namespace {

constexpr int kVisits = 48000;  // of contacts in a tick: 160 sweeps of the heap of 100 balls, 16 of one of 1000
constexpr int kFewestSweeps = 4, kMostSweeps = 160;
constexpr int kRestingSweeps = 2;  // of what was near enough before them: so a heap comes to rest
constexpr int kBetweenLooks = 4;   // a look at the residual costs half a sweep,
constexpr double kWorthALook = 4;  // and a sweep that changed more than so many times what is enough needs none

}  // namespace

SolveResult solveLargeProblem(const ContactProblem& problem, double enough, double start, SolverScratch& scratch, double* r, double* u) {
  const int n = problem.contactCount();
  const bool rests = start <= enough;
  const int most = std::clamp(kVisits / n, kFewestSweeps, kMostSweeps);
  const double near_speed = kWorthALook * enough * referenceSpeed(problem);
  GaussSeidel method({problem.first_row, problem.mu, problem.sides, problem.q.data(), scratch.y.data(), problem.movers, problem.round},
                     scratch, r);
  double residual = start;
  int sweeps = 0, measured = 0;
  const auto isEnough = [&] {
    if (measured != sweeps) residual = respondedResidual(problem, r, scratch, u);
    measured = sweeps;
    return residual <= enough;
  };
  for (;;) {
    const bool is_spent = !spend(kPerContactSwept * n, scratch);
    method.sweep(false);  // to and fro would be half as fast: what was visited last learns nothing from being visited first
    ++sweeps;
    if (sweeps == most || (is_spent && sweeps >= kFewestSweeps)) break;  // contacts that are new have no impulse yet: every tick gets a few
    const double change = method.largestChange();
    const bool is_due = sweeps % kBetweenLooks == 0 ? change <= near_speed : rests && sweeps == kRestingSweeps;
    if (is_due && isEnough()) break;
    method.accelerate();
  }
  const bool converged = isEnough();
  return {converged ? SolveMethod::kGaussSeidel : SolveMethod::kNotConverged, sweeps, residual, start, converged};
}

}  // namespace pincer::engine
