#include "engine/solve/gauss_seidel.h"

#include "engine/solve/local_contact.h"

namespace pincer::engine {
namespace {

// Solves contact i with all others held; `it.u` follows.
void relaxContact(const ScaledProblem& problem, int i, Iterate& it) {
  const int m = problem.rowCount();
  const int first = problem.firstRow(i);
  const int rows = problem.rows(i);
  const double* const W = problem.W + first * (m + 1);
  double others[kMaxContactRows];  // the velocity that the others leave
  for (int k = 0; k < rows; ++k) {
    others[k] = it.u[first + k];
    for (int l = 0; l < rows; ++l) others[k] -= W[k + l * m] * it.r[first + l];
  }
  double r[kMaxContactRows];
  solveOneContact(W, m, others, rows, problem.friction(i), r);
  for (int l = 0; l < rows; ++l) {
    const double change = r[l] - it.r[first + l];
    for (int row = 0; row < m; ++row) it.u[row] += problem.W[(first + l) * m + row] * change;
    it.r[first + l] = r[l];
  }
}

}  // namespace

void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, Iterate& it) {
  evaluate(problem, it);
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int i = 0; i < problem.contactCount(); ++i) relaxContact(problem, i, it);
  evaluate(problem, it);
}

}  // namespace pincer::engine
