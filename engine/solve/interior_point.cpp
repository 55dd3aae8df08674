#include "pincer/engine/solve/interior_point.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/solve/lorentz.h"

namespace pincer::engine {
namespace {

// S holds 1 / mu: frictionless contacts get this here, Newton's method corrects them
constexpr double kSmallestFriction = 1e-4;
constexpr double kStepFraction = 0.99;  // of the way to the boundary
constexpr double kNearer = 0.5;         // the gap after kStallSteps, or the path ends nowhere
constexpr int kStallSteps = 8;
constexpr double kSmallestStep = 1e-9;
constexpr double kRegularisation = 1e-13;  // of the unit diagonal of W^
constexpr double kSmoothing = 1e-15;       // of |u_T|, relative to the start's z

class CentralPath {
 public:
  CentralPath(const ScaledProblem& problem, ContactEquations& equations, SolverScratch& scratch, Iterate& it)
      : problem_(problem), equations_(equations), scratch_(scratch), it_(it) {
    double** const vectors[] = {&x_, &z_, &dx_, &dz_, &lambda_, &target_, &defect_, &t_};
    double* memory = scratch.workspace.data();
    for (double** vector : vectors) {
      *vector = memory;
      memory += problem.rowCount();
    }
    for (int row = 0; row < problem.rowCount(); ++row) size_ = std::max(size_, std::abs(problem.q[row]));
    // not whatever was there, times 0
    for (double* vector : {x_, z_, dx_, dz_}) std::fill(vector, vector + problem.rowCount(), 0.0);
    for (int i = 0; i < problem.contactCount(); ++i) x_[normal(i)] = z_[normal(i)] = size_;
    update();
  }

  // The frozen problem is solved to `fraction` of its start.
  bool isSolved(double fraction) const {
    double defect = 0;
    for (int row = 0; row < problem_.rowCount(); ++row) defect = std::max(defect, std::abs(defect_[row]));
    return defect <= fraction * size_ && meanGap(0) <= fraction * size_ * size_;
  }

  // False where the path has come to its end: Newton's method and the search finish what it began.
  bool comesNearer() {
    const double gap = meanGap(0);
    if (gap < kNearer * least_gap_) {
      least_gap_ = gap;
      patience_ = kStallSteps;
    }
    return patience_-- > 0;
  }

  // One predictor-corrector step; false when it can't go on.
  bool step() {
    const double gap = meanGap(0);
    constexpr std::int64_t kPerContact = 2000;  // scalings and products on cones, two solutions
    if (!spend(kPerContact * problem_.contactCount() + costOfLook(problem_), scratch_) || !linearise()) return false;
    aimAtBoundary();
    const double predicted = std::min(1.0, direct());
    const double centring = std::clamp(math::cube(std::max(meanGap(predicted), 0.0) / gap), 1e-6, 1.0);
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
      for (int k = 0; k < problem_.rows(i); ++k)
        it_.r[problem_.firstRow(i) + k] = stretch(i, k) * x_[problem_.firstRow(i) + k];
    evaluate(problem_, it_);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      const int rows = problem_.rows(i);
      const double* const u = it_.u + first;
      const double slip = std::sqrt(tangentNorm2(u, rows) + kSmoothing * kSmoothing * size_ * size_);
      setVector(t_ + first, rows, 1 / slip, u, 0);
      for (int k = 0; k < rows; ++k) defect_[first + k] = z_[first + k] - u[k];
      defect_[normal(i)] = z_[normal(i)] - u[kNormalRow] / friction(i) - slip;
    }
  }

  // x . z per contact, `length` along the direction.
  double meanGap(double length) const {
    double sum = 0;
    for (int row = 0; row < problem_.rowCount(); ++row)
      sum += (x_[row] + length * dx_[row]) * (z_[row] + length * dz_[row]);
    return sum / problem_.contactCount();
  }

  // act(first row, number of rows), as a constant where that is usual, of contact i.
  template <class Act>
  [[gnu::always_inline]] void atContact(int i, const Act& act) const {
    withRows(problem_.rows(i), [&](auto rows) { act(problem_.firstRow(i), rows); });
  }

  // The equations for dr = S dx:  N^2 S^-1 dr + (I + e_n t^T) S W^ dr = right-hand side.
  bool linearise() {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      atContact(i, [&](int first, auto rows) {
        const NesterovTodd N(x_ + first, z_ + first, rows);
        N.apply(x_ + first, rows, lambda_ + first);
        double E[ContactTerms::kSize], P[ContactTerms::kSize];
        for (int k = 0; k < rows; ++k) {
          double column[kMaxContactRows] = {};
          column[k] = 1;
          N.apply(column, rows, column);
          N.apply(column, rows, column);
          for (int l = 0; l < rows; ++l) {
            E[kMaxContactRows * l + k] = (column[l] + (k == l ? kRegularisation : 0)) / stretch(i, k);
            P[kMaxContactRows * l + k] = k == l ? stretch(i, k) : l == kNormalRow ? t_[first + k] : 0;
          }
        }
        equations_.setGeneral(i, E, P);
      });
    }
    return equations_.factorise();
  }

  // c = -lambda o lambda: straight to complementarity.
  void aimAtBoundary() {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      atContact(i, [&](int first, auto rows) {
        jordanProduct(lambda_ + first, lambda_ + first, rows, target_ + first);
        for (int k = 0; k < rows; ++k) target_[first + k] = -target_[first + k];
      });
    }
  }

  // c = gap e - lambda o lambda - (N dx) o (N^-1 dz), Mehrotra's second-order term from the predictor.
  void aimAtCentre(double gap, double second_order) {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      atContact(i, [&](int first, auto rows) {
        const NesterovTodd N(x_ + first, z_ + first, rows);
        double a[kMaxContactRows], b[kMaxContactRows];
        N.apply(dx_ + first, rows, a);
        N.applyInverse(dz_ + first, rows, b);
        jordanProduct(a, b, rows, a);
        for (int k = 0; k < rows; ++k) target_[first + k] -= second_order * a[k];
        target_[normal(i)] += gap;
      });
    }
  }

  // dx and dz towards the target; returns the step to the boundary.
  double direct() {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      atContact(i, [&](int first, auto rows) {
        jordanDivide(lambda_ + first, target_ + first, rows, dx_ + first);
        NesterovTodd(x_ + first, z_ + first, rows).apply(dx_ + first, rows, dx_ + first);
        for (int k = 0; k < rows; ++k) dx_[first + k] += defect_[first + k];
      });
    }
    equations_.solve(dx_);
    double* const W_dr = scratch_.step.data();
    multiply(problem_, dx_, W_dr);
    double length = 1e3;
    for (int i = 0; i < problem_.contactCount(); ++i) {
      atContact(i, [&](int first, auto rows) {
        for (int k = 0; k < rows; ++k) dx_[first + k] /= stretch(i, k);
        respond(i, W_dr + first, dz_ + first);
        length = std::min(
            {length, stepToBoundary(x_ + first, dx_ + first, rows), stepToBoundary(z_ + first, dz_ + first, rows)});
      });
    }
    return length;
  }

  // dz of contact i: (I + e_n t^T) S W^ dr, less what z lacked.
  void respond(int i, const double* W_dr, double* dz) const {
    const int first = problem_.firstRow(i), rows = problem_.rows(i);
    for (int k = 0; k < rows; ++k) dz[k] = stretch(i, k) * W_dr[k] - defect_[first + k];
    dz[kNormalRow] += tangentDot(t_ + first, W_dr, rows);
  }

  const ScaledProblem& problem_;
  ContactEquations& equations_;
  SolverScratch& scratch_;
  Iterate& it_;
  double *x_, *z_, *dx_, *dz_, *lambda_, *target_, *defect_, *t_;
  double size_ = 0;  // of the problem's velocities [sqrt(J)]
  double least_gap_ = std::numeric_limits<double>::infinity();
  int patience_ = kStallSteps;  // steps left to come nearer
};

}  // namespace

int followCentralPath(const ScaledProblem& problem, double tolerance, int iterations, ContactEquations& equations,
                      SolverScratch& scratch, Iterate& current) {
  CentralPath path(problem, equations, scratch, current);
  for (int n = 0; n < iterations; ++n)
    if (current.residual <= tolerance || path.isSolved(tolerance) || !path.comesNearer() || !path.step()) return n;
  return iterations;
}

}  // namespace pincer::engine
