#include "engine/solve/gauss_seidel.h"

#include <algorithm>
#include <limits>

#include "engine/solve/cone.h"
#include "engine/solve/inverse3.h"
#include "engine/solve/linear.h"
#include "engine/solve/local_contact.h"
#include "engine/solve/mobility.h"

namespace pincer::engine {
namespace {

// inverse = W^-1, rows x rows. Not a number where there is none: such a stop is in no cone.
void invertOwn(int rows, const double* W, double* inverse) {
  const auto fail = [&] { std::fill(inverse, inverse + rows * rows, std::numeric_limits<double>::quiet_NaN()); };
  if (rows == kTorsionRow) {
    if (!invert3<kTorsionRow>(W, inverse)) fail();
    return;
  }
  double factors[kMaxContactRows * kMaxContactRows];
  std::copy(W, W + rows * rows, factors);
  if (!factoriseLdlt(factors, rows)) return fail();
  for (int l = 0; l < rows; ++l) {
    double* const column = inverse + rows * l;
    std::fill(column, column + rows, 0.0);
    column[l] = 1;
    solveLdlt(factors, rows, column);
  }
}

int mostRows(const SweptProblem& problem) {
  int most = 0;
  for (int i = 0; i < problem.contactCount(); ++i) most = std::max(most, problem.rows(i));
  return most;
}

}  // namespace

GaussSeidel::GaussSeidel(const SweptProblem& problem, SolverScratch& scratch, double* r)
    : problem_(problem),
      r_(r),
      terms_(scratch.local.data()),
      change_(scratch.step.data()),
      direction_(scratch.response.data()),
      y_before_(scratch.rhs.data()),
      y_direction_(scratch.interior.data()),
      weight_(scratch.weight.data()) {
  const int most = mostRows(problem);
  stride_ = 2 * most * most;
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int rows = problem.rows(i);
    double* const W = termsOf(i);
    std::fill(W, W + rows * rows, 0.0);
    for (const ContactSide& side : problem.sides[static_cast<std::size_t>(i)]) {
      if (side.mover >= 0) addCoupling(side, rows, side, rows, W, rows);
    }
    invertOwn(rows, W, W + rows * rows);
  }
  respond();
}

// y = A^T r
void GaussSeidel::respond() {
  const int size = kMoverFreedoms * problem_.movers;
  std::fill(problem_.y, problem_.y + size, 0.0);
  for (int i = 0; i < problem_.contactCount(); ++i) {
    addImpulse(problem_.sides[static_cast<std::size_t>(i)], problem_.rows(i), r_ + problem_.firstRow(i), problem_.y);
  }
  std::copy(problem_.y, problem_.y + size, y_before_);
}

// Solves contact i with all others held; the movers' y follows.
void GaussSeidel::relax(int i) {
  const ContactSides& sides = problem_.sides[static_cast<std::size_t>(i)];
  const int first = problem_.firstRow(i);
  double *const r_i = r_ + first, *const change_i = change_ + first;
  const double* const W = termsOf(i);
  withRows(problem_.rows(i), [&](auto rows) {
    for (int k = 0; k < rows; ++k) change_i[k] = 0;
    double u[kMaxContactRows], r[kMaxContactRows];
    for (int k = 0; k < rows; ++k) u[k] = problem_.q[first + k];
    addVelocity(sides, rows, problem_.y, u);
    if (r_i[kNormalRow] == 0 && u[kNormalRow] >= 0) return;  // open, and stays so
    const double* const inverse = W + rows * rows;
    for (int k = 0; k < rows; ++k) {
      r[k] = r_i[k];
      for (int l = 0; l < rows; ++l) r[k] -= inverse[rows * l + k] * u[l];
    }
    if (!isInCone(r, rows, problem_.friction(i))) {  // it doesn't stick
      for (int k = 0; k < rows; ++k) {
        for (int l = 0; l < rows; ++l) u[k] -= W[rows * l + k] * r_i[l];
      }
      solveOneContact(W, rows, u, rows, problem_.friction(i), r);
    }
    double way2 = 0;
    for (int k = 0; k < rows; ++k) {
      change_i[k] = r[k] - r_i[k];
      r_i[k] = r[k];
      way2 += change_i[k] * change_i[k];
    }
    way2_ += weight_[i] * way2;
    largest_change2_ = std::max(largest_change2_, weight_[i] * weight_[i] * way2);
    addImpulse(sides, rows, change_i, problem_.y);
  });
}

void GaussSeidel::sweep(bool backwards) {
  const int n = problem_.contactCount();
  way2_before_ = way2_;
  way2_ = largest_change2_ = 0;
  for (int k = 0; k < n; ++k) relax(backwards ? n - 1 - k : k);
}

// y follows r by linearity: only what the cones take back goes through A.
void GaussSeidel::accelerate() {
  const double ratio = way2_before_ > 0 && way2_ <= way2_before_ ? way2_ / way2_before_ : 0;  // 0: begin anew
  const int size = kMoverFreedoms * problem_.movers;
  if (ratio == 0) {
    std::copy(change_, change_ + problem_.rowCount(), direction_);
    for (int j = 0; j < size; ++j) y_direction_[j] = problem_.y[j] - y_before_[j];
  } else {
    for (int j = 0; j < size; ++j) {
      const double further = ratio * y_direction_[j];
      y_direction_[j] = further + (problem_.y[j] - y_before_[j]);
      problem_.y[j] += further;
    }
    for (int i = 0; i < problem_.contactCount(); ++i) goFurther(i, ratio);
  }
  std::copy(problem_.y, problem_.y + size, y_before_);
}

void GaussSeidel::goFurther(int i, double ratio) {
  const int first = problem_.firstRow(i);
  double *const r_i = r_ + first, *const direction = direction_ + first;
  withRows(problem_.rows(i), [&](auto rows) {
    for (int k = 0; k < rows; ++k) {
      const double further = ratio * direction[k];
      direction[k] = further + change_[first + k];
      r_i[k] += further;
    }
    if (isInCone(r_i, rows, problem_.friction(i))) return;
    double back[kMaxContactRows];
    projectOntoCone(r_i, rows, problem_.friction(i), back);
    for (int k = 0; k < rows; ++k) {
      const double inside = back[k];
      back[k] -= r_i[k];
      r_i[k] = inside;
    }
    addImpulse(problem_.sides[static_cast<std::size_t>(i)], rows, back, problem_.y);
  });
}

void sweepGaussSeidel(const ScaledProblem& problem, int sweeps, SolverScratch& scratch, Iterate& it) {
  GaussSeidel method({problem.first_row, problem.mu, problem.sides, problem.q, problem.y, problem.movers}, scratch, it.r);
  for (int n = 0; n < sweeps && spend(kPerContactSwept * problem.contactCount(), scratch); ++n) method.sweep(false);
  evaluate(problem, it);
}

}  // namespace pincer::engine
