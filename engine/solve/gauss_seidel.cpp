#include "engine/solve/gauss_seidel.h"

#include "engine/solve/local_contact.h"
#include "engine/solve/residual.h"

namespace pincer::engine {
namespace {

// Solves contact i with all others held.
void relaxContact(const ScaledProblem& problem, int i, double* r) {
  const int m = problem.rowCount();
  const int first = problem.firstRow(i);
  const int rows = problem.rows(i);
  for (int k = 0; k < rows; ++k) r[first + k] = 0;
  double others[kMaxContactRows];  // the velocity that the others leave
  contactVelocity(problem.W + first, m, problem.q + first, r, rows, others);
  solveOneContact(problem.W + first * (m + 1), m, others, rows, problem.friction(i), r + first);
}

}  // namespace

void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, Iterate& it) {
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int i = 0; i < problem.contactCount(); ++i) relaxContact(problem, i, it.r);
  evaluate(problem, it);
}

}  // namespace pincer::engine
