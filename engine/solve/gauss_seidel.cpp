#include "engine/solve/gauss_seidel.h"

#include <algorithm>

#include "engine/solve/local_contact.h"
#include "engine/solve/mobility.h"

namespace pincer::engine {
namespace {

// Solves contact i with all others held; the movers' y follows.
void relaxContact(const ScaledProblem& problem, const double* W_ii, int i, Iterate& it) {
  const int first = problem.firstRow(i), rows = problem.rows(i);
  const ContactSides& sides = problem.sides[static_cast<std::size_t>(i)];
  double* const r_i = it.r + first;
  double others[kMaxContactRows];  // the velocity that the others leave
  std::copy(problem.q + first, problem.q + first + rows, others);
  addVelocity(sides, rows, problem.y, others);
  for (int l = 0; l < rows; ++l) {
    for (int k = 0; k < rows; ++k) others[k] -= W_ii[kMaxContactRows * l + k] * r_i[l];
  }
  double r[kMaxContactRows], change[kMaxContactRows];
  solveOneContact(W_ii, kMaxContactRows, others, rows, problem.friction(i), r);
  for (int k = 0; k < rows; ++k) change[k] = r[k] - r_i[k];
  std::copy(r, r + rows, r_i);
  addImpulse(sides, rows, change, problem.y);
}

}  // namespace

void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, SolverScratch& scratch, Iterate& it) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    double* const W_ii = scratch.terms[static_cast<std::size_t>(i)].G;
    std::fill(W_ii, W_ii + ContactTerms::kSize, 0.0);
    for (const ContactSide& side : problem.sides[static_cast<std::size_t>(i)]) {
      if (side.mover >= 0) addCoupling(side, problem.rows(i), side, problem.rows(i), W_ii, kMaxContactRows);
    }
  }
  std::fill(problem.y, problem.y + kMoverFreedoms * problem.movers, 0.0);
  for (int i = 0; i < problem.contactCount(); ++i) {
    addImpulse(problem.sides[static_cast<std::size_t>(i)], problem.rows(i), it.r + problem.firstRow(i), problem.y);
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int i = 0; i < problem.contactCount(); ++i) relaxContact(problem, scratch.terms[static_cast<std::size_t>(i)].G, i, it);
  }
  evaluate(problem, it);
}

}  // namespace pincer::engine
