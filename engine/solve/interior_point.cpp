#include "engine/solve/interior_point.h"

#include <algorithm>

#include "engine/solve/linear.h"
#include "engine/solve/lorentz.h"

namespace pincer::engine {
namespace {

constexpr double kSmallestFriction = 1e-4;  // S holds 1 / mu: frictionless contacts get this here, Newton's method corrects them
constexpr double kStepFraction = 0.99;      // of the way to the boundary
constexpr double kSmallestStep = 1e-9;
constexpr double kRegularisation = 1e-13;  // of the unit diagonal of W^
constexpr double kSmoothing = 1e-15;       // of |u_T|, relative to the start's z

class CentralPath {
 public:
  CentralPath(const ScaledProblem& problem, const double* shift, SolverScratch& scratch, Iterate& it)
      : problem_(problem), shift_(shift), scratch_(scratch), it_(it) {
    double** const vectors[] = {&x_, &z_, &dx_, &dz_, &lambda_, &target_, &defect_, &t_};
    double* memory = scratch.interior.data();
    for (double** vector : vectors) {
      *vector = memory;
      memory += problem.rowCount();
    }
    for (int row = 0; row < problem.rowCount(); ++row) size_ = std::max(size_, std::abs(problem.q[row]));
    std::fill(x_, x_ + problem.rowCount(), 0.0);
    std::fill(z_, z_ + problem.rowCount(), 0.0);
    for (int i = 0; i < problem.contactCount(); ++i) x_[normal(i)] = z_[normal(i)] = size_;
    update();
  }

  // The frozen problem is solved to `fraction` of its start.
  bool isSolved(double fraction) const {
    double defect = 0;
    for (int row = 0; row < problem_.rowCount(); ++row) defect = std::max(defect, std::abs(defect_[row]));
    return defect <= fraction * size_ && meanGap(0) <= fraction * size_ * size_;
  }

  // One predictor-corrector step; false when it can't go on.
  bool step() {
    const double gap = meanGap(0);
    if (!linearise()) return false;
    aimAtBoundary();
    const double predicted = std::min(1.0, direct());
    const double centring = std::clamp(std::pow(std::max(meanGap(predicted), 0.0) / gap, 3), 1e-6, 1.0);
    aimAtCentre((predicted < 0.1 ? std::max(centring, 0.3) : centring) * gap, predicted < 0.1 ? 0 : 1);
    const double length = std::min(1.0, kStepFraction * direct());
    if (!(length > kSmallestStep)) return false;
    for (int row = 0; row < problem_.rowCount(); ++row) {
      x_[row] += length * dx_[row];
      z_[row] += length * dz_[row];
    }
    update();
    return std::isfinite(it_.residual);
  }

 private:
  int normal(int i) const { return problem_.firstRow(i) + kNormalRow; }
  double friction(int i) const { return std::max(problem_.friction(i), kSmallestFriction); }
  // S's diagonal
  double stretch(int i, int k) const { return k == kNormalRow ? 1 / friction(i) : 1; }

  // Impulses, velocities and shift of the current x; what z still lacks.
  void update() {
    for (int i = 0; i < problem_.contactCount(); ++i)
      for (int k = 0; k < problem_.rows(i); ++k) it_.r[problem_.firstRow(i) + k] = stretch(i, k) * x_[problem_.firstRow(i) + k];
    evaluate(problem_, it_);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      const int rows = problem_.rows(i);
      const double* const u = it_.u + first;
      const double slip = shift_ ? shift_[i] : std::sqrt(tangentNorm2(u, rows) + kSmoothing * kSmoothing * size_ * size_);
      setVector(t_ + first, rows, shift_ ? 0 : 1 / slip, u, 0);
      for (int k = 0; k < rows; ++k) defect_[first + k] = z_[first + k] - u[k];
      defect_[normal(i)] = z_[normal(i)] - u[kNormalRow] / friction(i) - slip;
    }
  }

  // x . z per contact, `length` along the direction.
  double meanGap(double length) const {
    double sum = 0;
    for (int row = 0; row < problem_.rowCount(); ++row) sum += (x_[row] + length * dx_[row]) * (z_[row] + length * dz_[row]);
    return sum / problem_.contactCount();
  }

  // S W^ S with (I + e_n t^T) in front: the block column of contact j's k-th row, for contact i.
  void mobility(int i, int j, int k, double* column) const {
    const int m = problem_.rowCount();
    const int rows = problem_.rows(i);
    const double* const W = problem_.W + (problem_.firstRow(j) + k) * m + problem_.firstRow(i);
    for (int l = 0; l < rows; ++l) column[l] = W[l] * stretch(i, l) * stretch(j, k);
    column[kNormalRow] += tangentDot(t_ + problem_.firstRow(i), column, rows);
  }

  bool linearise() {
    const int m = problem_.rowCount();
    double* const A = scratch_.jacobian.data();
    for (int j = 0; j < problem_.contactCount(); ++j)
      for (int k = 0; k < problem_.rows(j); ++k)
        for (int i = 0; i < problem_.contactCount(); ++i) mobility(i, j, k, A + (problem_.firstRow(j) + k) * m + problem_.firstRow(i));
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      const int rows = problem_.rows(i);
      const NesterovTodd N(x_ + first, z_ + first, rows);
      N.apply(x_ + first, rows, lambda_ + first);
      for (int k = 0; k < rows; ++k) {
        double column[kMaxContactRows] = {};
        column[k] = 1;
        N.apply(column, rows, column);
        N.apply(column, rows, column);
        for (int l = 0; l < rows; ++l) A[(first + k) * m + first + l] += column[l] + (k == l ? kRegularisation : 0);
      }
    }
    return factoriseLu(A, m, scratch_.pivots.data());
  }

  // c = -lambda o lambda: straight to complementarity.
  void aimAtBoundary() {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      jordanProduct(lambda_ + first, lambda_ + first, problem_.rows(i), target_ + first);
      for (int k = 0; k < problem_.rows(i); ++k) target_[first + k] = -target_[first + k];
    }
  }

  // c = gap e - lambda o lambda - (N dx) o (N^-1 dz), Mehrotra's second-order term from the predictor.
  void aimAtCentre(double gap, double second_order) {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      const int rows = problem_.rows(i);
      const NesterovTodd N(x_ + first, z_ + first, rows);
      double a[kMaxContactRows], b[kMaxContactRows];
      N.apply(dx_ + first, rows, a);
      N.applyInverse(dz_ + first, rows, b);
      jordanProduct(a, b, rows, a);
      for (int k = 0; k < rows; ++k) target_[first + k] -= second_order * a[k];
      target_[normal(i)] += gap;
    }
  }

  // dx and dz towards the target; returns the step to the boundary.
  double direct() {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      const int rows = problem_.rows(i);
      jordanDivide(lambda_ + first, target_ + first, rows, dx_ + first);
      NesterovTodd(x_ + first, z_ + first, rows).apply(dx_ + first, rows, dx_ + first);
      for (int k = 0; k < rows; ++k) dx_[first + k] += defect_[first + k];
    }
    solveLu(scratch_.jacobian.data(), problem_.rowCount(), scratch_.pivots.data(), dx_);
    double length = 1e3;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      responseTo(i, dz_ + first);
      length = std::min(
          {length, stepToBoundary(x_ + first, dx_ + first, problem_.rows(i)), stepToBoundary(z_ + first, dz_ + first, problem_.rows(i))});
    }
    return length;
  }

  // dz of contact i.
  void responseTo(int i, double* dz) const {
    for (int k = 0; k < problem_.rows(i); ++k) dz[k] = -defect_[problem_.firstRow(i) + k];
    double column[kMaxContactRows];
    for (int j = 0; j < problem_.contactCount(); ++j)
      for (int k = 0; k < problem_.rows(j); ++k) {
        mobility(i, j, k, column);
        for (int l = 0; l < problem_.rows(i); ++l) dz[l] += column[l] * dx_[problem_.firstRow(j) + k];
      }
  }

  const ScaledProblem& problem_;
  const double* shift_;
  SolverScratch& scratch_;
  Iterate& it_;
  double *x_, *z_, *dx_, *dz_, *lambda_, *target_, *defect_, *t_;
  double size_ = 0;  // of the problem's velocities [sqrt(J)]
};

}  // namespace

int followCentralPath(const ScaledProblem& problem, const double* shift, double tolerance, int iterations, SolverScratch& scratch,
                      Iterate& it) {
  CentralPath path(problem, shift, scratch, it);
  for (int n = 0; n < iterations; ++n)
    if (it.residual <= tolerance || path.isSolved(tolerance) || !path.step()) return n;
  return iterations;
}

}  // namespace pincer::engine
