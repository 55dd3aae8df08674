#include "engine/solve/gauss_seidel.h"

#include <algorithm>

#include "engine/solve/cone.h"
#include "engine/solve/linear.h"
#include "engine/solve/local_contact.h"
#include "engine/solve/mobility.h"

namespace pincer::engine {
namespace {

constexpr int kWidth = kMaxContactRows;

// t.K_inverse = t.G^-1, t.coupling says whether there is one.
void invertOwn(int rows, ContactTerms& t) {
  double factors[ContactTerms::kSize];
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) factors[l * rows + k] = t.G[kWidth * k + l];
  }
  t.coupling = factoriseLdlt(factors, rows) ? Coupling::kGeneral : Coupling::kNone;
  for (int l = 0; l < rows && t.coupling == Coupling::kGeneral; ++l) {
    double column[kMaxContactRows] = {};
    column[l] = 1;
    solveLdlt(factors, rows, column);
    for (int k = 0; k < rows; ++k) t.K_inverse[kWidth * k + l] = column[k];
  }
}

// W_ii and its inverse, where it has one, of each contact: in ContactTerms::G and K_inverse.
void prepareContact(const ScaledProblem& problem, int i, ContactTerms& t) {
  const int rows = problem.rows(i);
  std::fill(t.G, t.G + kWidth * rows, 0.0);
  std::fill(t.K_inverse, t.K_inverse + kWidth * rows, 0.0);
  for (const ContactSide& side : problem.sides[static_cast<std::size_t>(i)]) {
    if (side.mover >= 0) addCoupling(side, rows, side, rows, t.G, kWidth);
  }
  invertOwn(rows, t);
}

// y = A x
void multiplyLocal(const double* A, const double* x, int rows, double* y) {
  for (int k = 0; k < rows; ++k) {
    y[k] = 0;
    for (int l = 0; l < rows; ++l) y[k] += A[kWidth * k + l] * x[l];
  }
}

// The impulses r that solve contact i where the others leave the velocity `others`; `change` takes it from r_i to a standstill.
void solveLocally(const ContactTerms& t, const double* others, const double* r_i, const double* change, int rows, double mu, double* r) {
  for (int k = 0; k < rows; ++k) r[k] = 0;
  if (others[kNormalRow] >= 0) return;
  if (t.coupling == Coupling::kGeneral) {  // as nearly always: it sticks
    for (int k = 0; k < rows; ++k) r[k] = r_i[k] - change[k];
    if (isInCone(r, rows, mu)) return;
  }
  solveOneContact(t.G, kWidth, others, rows, mu, r);
}

// Solves contact i with all others held; the movers' y follows.
void relaxContact(const ScaledProblem& problem, const ContactTerms& t, int i, Iterate& it) {
  const ContactSides& sides = problem.sides[static_cast<std::size_t>(i)];
  double* const r_i = it.r + problem.firstRow(i);
  const double* const q_i = problem.q + problem.firstRow(i);
  withRows(problem.rows(i), [&](auto rows) {
    double u[kMaxContactRows], own[kMaxContactRows], stop[kMaxContactRows], r[kMaxContactRows];
    for (int k = 0; k < rows; ++k) u[k] = q_i[k];
    addVelocity(sides, rows, problem.y, u);
    if (r_i[kNormalRow] == 0 && u[kNormalRow] >= 0) return;  // open, and stays so
    multiplyLocal(t.G, r_i, rows, own);
    multiplyLocal(t.K_inverse, u, rows, stop);
    for (int k = 0; k < rows; ++k) u[k] -= own[k];
    solveLocally(t, u, r_i, stop, rows, problem.friction(i), r);
    for (int k = 0; k < rows; ++k) {
      stop[k] = r[k] - r_i[k];
      r_i[k] = r[k];
    }
    addImpulse(sides, rows, stop, problem.y);
  });
}

}  // namespace

void prepareGaussSeidel(const ScaledProblem& problem, SolverScratch& scratch) {
  for (int i = 0; i < problem.contactCount(); ++i) prepareContact(problem, i, scratch.terms[static_cast<std::size_t>(i)]);
}

void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, SolverScratch& scratch, Iterate& it) {
  std::fill(problem.y, problem.y + kMoverFreedoms * problem.movers, 0.0);
  for (int i = 0; i < problem.contactCount(); ++i) {
    addImpulse(problem.sides[static_cast<std::size_t>(i)], problem.rows(i), it.r + problem.firstRow(i), problem.y);
  }
  for (int sweep = 0; sweep < sweeps && spend(kPerContactSwept * problem.contactCount(), scratch); ++sweep) {
    for (int i = 0; i < problem.contactCount(); ++i) relaxContact(problem, scratch.terms[static_cast<std::size_t>(i)], i, it);
  }
  evaluate(problem, it);
}

}  // namespace pincer::engine
