#include "engine/solve/newton.h"

#include <algorithm>
#include <utility>

#include "engine/solve/cone.h"
#include "engine/solve/linear.h"

namespace pincer::engine {
namespace {

constexpr double kRegularisation = 1e-11;     // far above round-off, far below the W^ of one contact (1)
constexpr int kTrials = 6;                    // step lengths 1, 1/2, .. 1/32
constexpr double kSufficientDecrease = 1e-4;  // Armijo's, on |Phi|^2

// Phi of one contact, y, and how the contact acts.
ContactMode alartCurnier(const double* r, const double* u, int rows, double mu, double* y, double* phi) {
  for (int k = 0; k < rows; ++k) y[k] = r[k] - u[k];
  const ContactMode mode = contactMode(y, rows, mu);
  if (mode == ContactMode::kOpen) {
    for (int k = 0; k < rows; ++k) phi[k] = r[k];
  } else if (mode == ContactMode::kStick) {
    for (int k = 0; k < rows; ++k) phi[k] = u[k];
  } else {
    const double s = mu * y[kNormalRow] / std::sqrt(tangentNorm2(y, rows));
    for (int k = 0; k < rows; ++k) phi[k] = r[k] - s * y[k];
    phi[kNormalRow] = u[kNormalRow];
  }
  return mode;
}

double merit(const ScaledProblem& problem, const Iterate& it) {
  double sum = 0;
  double y[kMaxContactRows];
  double phi[kMaxContactRows];
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int rows = problem.rows(i);
    alartCurnier(it.r + problem.firstRow(i), it.u + problem.firstRow(i), rows, problem.friction(i), y, phi);
    for (int k = 0; k < rows; ++k) sum += phi[k] * phi[k];
  }
  return sum;
}

bool carriesNothing(const double* r, int rows) {
  bool nothing = true;
  for (int k = 0; k < rows; ++k) nothing = nothing && r[k] == 0;
  return nothing;
}

// Newton's equations of the active contacts, assembled contact by contact in SolverScratch.
class Equations {
 public:
  Equations(const ScaledProblem& problem, const Iterate& it, SolverScratch& scratch)
      : problem_(problem),
        it_(it),
        active_(scratch.active.data()),
        A_(scratch.jacobian.data()),
        b_(scratch.step.data()),
        pivots_(scratch.pivots.data()) {
    double y[kMaxContactRows];
    double phi[kMaxContactRows];
    for (int i = 0; i < problem.contactCount(); ++i) {
      const int first = problem.firstRow(i);
      const int rows = problem.rows(i);
      const bool open = alartCurnier(it.r + first, it.u + first, rows, problem.friction(i), y, phi) == ContactMode::kOpen;
      if (open && carriesNothing(it.r + first, rows)) continue;
      active_[count_++] = i;
      size_ += rows;
    }
  }

  // Solves for dr; false if the equations are singular in spite of epsilon.
  bool solve() {
    bool symmetric = true;
    int row = 0;
    for (int a = 0; a < count_; ++a) row += assemble(active_[a], row, symmetric);
    for (int k = 0; k < size_; ++k) A_[k * (size_ + 1)] += kRegularisation;
    if (symmetric) return solveByLdlt(A_, size_, b_);
    if (!factoriseLu(A_, size_, pivots_)) return false;
    solveLu(A_, size_, pivots_, b_);
    return true;
  }

  // r = P_K(r + t dr)
  void step(double t, double* r) const {
    for (int row = 0; row < problem_.rowCount(); ++row) r[row] = 0;
    const double* dr = b_;
    for (int a = 0; a < count_; ++a) {
      const int first = problem_.firstRow(active_[a]);
      const int rows = problem_.rows(active_[a]);
      for (int k = 0; k < rows; ++k) r[first + k] = it_.r[first + k] + t * dr[k];
      projectOntoCone(r + first, rows, problem_.friction(active_[a]), r + first);
      dr += rows;
    }
  }

 private:
  // Fills the rows of contact i; returns their number.
  int assemble(int i, int row, bool& symmetric) {
    double y[kMaxContactRows];
    const int first = problem_.firstRow(i);
    const int rows = problem_.rows(i);
    const ContactMode mode = alartCurnier(it_.r + first, it_.u + first, rows, problem_.friction(i), y, b_ + row);
    for (int k = 0; k < rows; ++k) b_[row + k] = -b_[row + k];
    symmetric = symmetric && mode == ContactMode::kStick;
    const SlideDerivative slide = mode == ContactMode::kSlide ? slideDerivative(y, rows, problem_.friction(i)) : SlideDerivative{};
    double* out = A_ + row;
    for (int a = 0; a < count_; ++a)
      for (int column = problem_.firstRow(active_[a]); column < problem_.firstRow(active_[a] + 1); ++column, out += size_) {
        const double* const W = problem_.W + column * problem_.rowCount() + first;
        const int diagonal = column - first;  // the row of this block that meets the diagonal, if within [0, rows)
        if (mode == ContactMode::kStick)
          for (int k = 0; k < rows; ++k) out[k] = W[k];
        else if (mode == ContactMode::kOpen)
          for (int k = 0; k < rows; ++k) out[k] = k == diagonal ? 1 : 0;
        else
          slideColumn(slide, W, rows, diagonal, out);
      }
    return rows;
  }

  // One column of (I - D) + D W = I + D (W - I).
  static void slideColumn(const SlideDerivative& slide, const double* W, int rows, int diagonal, double* out) {
    double d[kMaxContactRows] = {};
    for (int k = 0; k < rows; ++k) d[k] = k == diagonal ? W[k] - 1 : W[k];
    slide.apply(d, rows, out);
    if (diagonal >= 0 && diagonal < rows) out[diagonal] += 1;
  }

  const ScaledProblem& problem_;
  const Iterate& it_;
  int* active_;
  double* A_;
  double* b_;
  int* pivots_;
  int count_ = 0;
  int size_ = 0;
};

// Halves the step until |Phi| falls enough. If it never does the shortest step is taken all the same: that leaves the cycles and the corners of
// |Phi| where insisting on descent gets stuck (of 1000 grasps with 2-10 fingers from a cold start, 5 % fail instead of 8 %).
void searchLine(const ScaledProblem& problem, const Equations& equations, double tolerance, const Iterate& current, Iterate& trial) {
  const auto attempt = [&](double t) {
    equations.step(t, trial.r);
    evaluate(problem, trial);
    return trial.residual <= tolerance;
  };
  double t = 1;
  if (attempt(t)) return;  // as nearly always from a warm start: |Phi| needn't be known
  const double phi2 = merit(problem, current);
  for (int n = 1; n < kTrials; ++n) {
    if (merit(problem, trial) <= (1 - kSufficientDecrease * t) * phi2) return;
    t *= 0.5;
    if (attempt(t)) return;
  }
}

}  // namespace

int iterateNewton(const ScaledProblem& problem, double tolerance, int iterations, SolverScratch& scratch, Iterate& current,
                  Iterate& trial) {
  for (int n = 0; n < iterations; ++n) {
    if (current.residual <= tolerance || !std::isfinite(current.residual)) return n;
    Equations equations(problem, current, scratch);
    if (!equations.solve()) return n;
    searchLine(problem, equations, tolerance, current, trial);
    std::swap(current, trial);
  }
  return iterations;
}

}  // namespace pincer::engine
