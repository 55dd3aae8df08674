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
    if (!invertSymmetric3<kTorsionRow>(W, inverse)) fail();
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
  stride_ = kTermsBefore + 2 * most * most;
  for (int i = 0; i < problem.contactCount(); ++i) fillTerms(i);
  std::copy(problem_.y, problem_.y + kMoverFreedoms * problem_.movers, y_before_);
}

void GaussSeidel::fillTerms(int i) {
  const int rows = problem_.rows(i);
  double *const terms = termsOf(i), *const inverse = terms + kTermsBefore, *const W = inverse + rows * rows;
  std::fill(W, W + rows * rows, 0.0);
  for (const ContactSide& side : problem_.sides[static_cast<std::size_t>(i)]) {
    if (side.mover >= 0) addCoupling(side, rows, side, rows, W, rows);
  }
  const bool is_isotropic = rows == kTorsionRow && isIsotropic(W, rows);
  terms[0] = is_isotropic ? 1 / W[0] : 0;
  terms[1] = 1 / W[kNormalRow * (rows + 1)];
  if (!is_isotropic) invertOwn(rows, W, inverse);
}

// Whether contact i pushes on nothing and doesn't close: so are many of a heap's, and most rows needn't be looked at.
bool GaussSeidel::staysOpen(int i) const {
  const int normal = problem_.firstRow(i) + kNormalRow;
  if (r_[normal] != 0) return false;
  double u = problem_.q[normal];
  for (const ContactSide& side : problem_.sides[static_cast<std::size_t>(i)]) {
    if (side.mover >= 0) u += dot6(side.A[kNormalRow], problem_.y + kMoverFreedoms * side.mover);
  }
  return u >= 0;
}

// Solves contact i with all others held; the movers' y follows.
void GaussSeidel::relax(int i) {
  const ContactSides& sides = problem_.sides[static_cast<std::size_t>(i)];
  const int first = problem_.firstRow(i);
  double *const r_i = r_ + first, *const change_i = change_ + first;
  withRows(problem_.rows(i), [&](auto rows) {
    if (staysOpen(i)) return std::fill(change_i, change_i + rows, 0.0);
    double u[kMaxContactRows], r[kMaxContactRows];
    velocityOf(sides, rows, problem_.q + first, problem_.y, u);
    solveOwn(i, rows, u, r);
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

// r = the impulse of contact i, which has the velocity u with the present one.
template <class Rows>
[[gnu::always_inline]] inline void GaussSeidel::solveOwn(int i, Rows rows, double* u, double* r) {
  const double *const terms = termsOf(i), *const inverse = terms + kTermsBefore, *const W = inverse + rows * rows;
  const double* const r_i = r_ + problem_.firstRow(i);
  if (terms[0] > 0) {
    for (int k = 0; k < kTorsionRow; ++k) r[k] = r_i[k] - terms[k == kNormalRow] * u[k];
    return limitFriction(problem_.friction(i), r);
  }
  for (int k = 0; k < rows; ++k) {
    r[k] = r_i[k];
    for (int l = 0; l < rows; ++l) r[k] -= inverse[rows * l + k] * u[l];
  }
  if (isInCone(r, rows, problem_.friction(i))) return;  // it sticks
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) u[k] -= W[rows * l + k] * r_i[l];
  }
  slide_steps_ += solveOneContact(W, rows, u, rows, problem_.friction(i), r);
}

void GaussSeidel::sweep(bool backwards) {
  const int n = problem_.contactCount();
  way2_before_ = way2_;
  way2_ = largest_change2_ = 0;
  slide_steps_ = 0;
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
  respond(problem.sides, problem.first_row, it.r, problem.movers, problem.y);
  GaussSeidel method({problem.first_row, problem.mu, problem.sides, problem.q, problem.y, problem.movers}, scratch, it.r);
  const auto costOfSweep = [&] { return kPerContactSwept * problem.contactCount() + kPerSlideStep * method.slideSteps(); };
  for (int n = 0; n < sweeps && spend(costOfSweep(), scratch); ++n) method.sweep(false);
  evaluate(problem, it);
}

}  // namespace pincer::engine
