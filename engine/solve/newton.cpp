#include "pincer/engine/solve/newton.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/proximal_round.h"
#include "pincer/engine/solve/squeeze.h"

namespace pincer::engine {
namespace {

constexpr double kMoversEpsilon = 1e-6;  // redundant contacts share their load by the round-off of their gaps over this
constexpr double kCorrected = 1e-8;      // of Newton's equations: what epsilon may leave of them
constexpr int kMostCorrections = 3;      // by the same factors
// of contacts that give way: as long as a round isn't solved, more
constexpr double kGivingEpsilon = 1e-2, kMoreEpsilon = 10;
constexpr int kStepsPerRound = 12;
constexpr double kFadesStill = 0.5;  // of the give of the round before
// steps without a residual half as large as the best before, after which it won't come
constexpr int kPatience = 5;

// Phi of one contact, y, and how the contact acts.
[[gnu::always_inline]] inline ContactMode alartCurnier(const double* r, const double* u, int rows, double mu, double* y,
                                                       double* phi) {
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

// The proximal term of a round: velocities count as u + epsilon (r - r_c).
struct Centre {
  const double* r = nullptr;  // null for none
  double epsilon = 0;
};

[[gnu::always_inline]] inline void velocityAt(const Iterate& it, const Centre& centre, int first, int rows, double* u) {
  for (int k = 0; k < rows; ++k) u[k] = it.u[first + k];
  if (!centre.r) return;
  for (int k = 0; k < rows; ++k) u[k] += centre.epsilon * (it.r[first + k] - centre.r[first + k]);
}

double merit(const ScaledProblem& problem, const Centre& centre, const Iterate& it) {
  double sum = 0;
  double y[kMaxContactRows] = {};
  double phi[kMaxContactRows];
  for (int i = 0; i < problem.contactCount(); ++i) {
    const int first = problem.firstRow(i), rows = problem.rows(i);
    withRows(rows, [&](auto count) {
      double u[kMaxContactRows];
      velocityAt(it, centre, first, count, u);
      alartCurnier(it.r + first, u, count, problem.friction(i), y, phi);
      for (int k = 0; k < count; ++k) sum += phi[k] * phi[k];
    });
  }
  return sum;
}

double largestOf(const double* x, int m) {
  double largest = 0;
  for (int k = 0; k < m; ++k) largest = std::max(largest, std::abs(x[k]));
  return largest;
}

// Newton's equations at one iterate.
class NewtonStep {
 public:
  NewtonStep(const ScaledProblem& problem, const Iterate& it, const Centre& centre, ContactEquations& equations,
             SolverScratch& scratch)
      : problem_(problem),
        it_(it),
        centre_(centre),
        equations_(equations),
        scratch_(scratch),
        dr_(scratch.step.data()) {
    epsilon_ = centre.r                                    ? centre.epsilon
               : equations.form() == EquationForm::kMovers ? kMoversEpsilon
                                                           : kContactsEpsilon;
  }

  // Solves for dr; false if the equations are singular in spite of epsilon.
  bool solve() {
    for (int i = 0; i < problem_.contactCount(); ++i) linearise(i);
    if (!equations_.factorise()) return false;
    const int m = problem_.rowCount();
    if (centre_.r || equations_.form() == EquationForm::kContacts) {
      equations_.solve(dr_);
      return true;
    }
    double* const b = scratch_.workspace.data();
    double* const correction = b + m;
    std::copy(dr_, dr_ + m, b);
    const double enough = kCorrected * largestOf(b, m);
    equations_.solve(dr_);
    subtractResponse(dr_, b);
    for (int n = 0; n < kMostCorrections && largestOf(b, m) > enough; ++n) {
      std::copy(b, b + m, correction);
      equations_.solve(correction);
      for (int row = 0; row < m; ++row) dr_[row] += correction[row];
      subtractResponse(correction, b);
    }
    return true;
  }

  // r = P_K(r + t dr)
  void step(double t, double* r) const {
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i);
      withRows(problem_.rows(i), [&](auto rows) {
        double moved[kMaxContactRows];  // not `r`: a pair read back just after its numbers were written waits for them
        for (int k = 0; k < rows; ++k) moved[k] = it_.r[first + k] + t * dr_[first + k];
        projectOntoCone(moved, rows, problem_.friction(i), r + first);
      });
    }
  }

 private:
  void linearise(int i) {
    withRows(problem_.rows(i), [&](auto rows) { lineariseRows(i, rows); });
  }
  template <class Rows>
  void lineariseRows(int i, Rows rows) {
    double y[kMaxContactRows] = {};
    const int first = problem_.firstRow(i);
    double u[kMaxContactRows];
    velocityAt(it_, centre_, first, rows, u);
    const ContactMode mode = alartCurnier(it_.r + first, u, rows, problem_.friction(i), y, dr_ + first);
    for (int k = first; k < first + rows; ++k) dr_[k] = -dr_[k];
    if (mode == ContactMode::kOpen) return equations_.decouple(i);
    if (mode == ContactMode::kStick) return equations_.identify(i, epsilon_);
    const SlideDerivative slide = slideDerivative(y, rows, problem_.friction(i));
    double E[ContactTerms::kSize], D[ContactTerms::kSize];
    for (int k = 0; k < rows; ++k) {
      for (int l = 0; l < rows; ++l) {
        const double d = slide.at(k, l), unit = k == l ? 1 : 0;
        D[kMaxContactRows * k + l] = d;
        E[kMaxContactRows * k + l] = unit - d + epsilon_ * (centre_.r ? d : unit);
      }
    }
    equations_.setGeneral(i, E, D);
  }

  // b -= (I - D) x + D W^ x: what a step x, taken with epsilon, leaves.
  void subtractResponse(const double* x, double* b) const {
    double* const W_x = scratch_.response.data();
    multiply(problem_, x, W_x);
    for (int i = 0; i < problem_.contactCount(); ++i) {
      const int first = problem_.firstRow(i), rows = problem_.rows(i);
      const ContactTerms& t = scratch_.terms[static_cast<std::size_t>(i)];
      for (int k = 0; k < rows; ++k) {
        if (t.coupling == Coupling::kNone) b[first + k] -= x[first + k];
        if (t.coupling == Coupling::kIdentity) b[first + k] -= W_x[first + k];
        if (t.coupling != Coupling::kGeneral) continue;
        b[first + k] += epsilon_ * x[first + k];
        for (int l = 0; l < rows; ++l) {
          b[first + k] -= t.E[kMaxContactRows * k + l] * x[first + l] + t.P[kMaxContactRows * k + l] * W_x[first + l];
        }
      }
    }
  }

  const ScaledProblem& problem_;
  const Iterate& it_;
  const Centre centre_;
  ContactEquations& equations_;
  SolverScratch& scratch_;
  double* dr_;
  double epsilon_;
};

// Halves the step until |Phi| falls enough. If it never does the shortest step is taken all the same:
// that leaves the cycles and the corners of
// |Phi| where insisting on descent gets stuck (of 1000 grasps with 2-10 fingers
// from a cold start, 5 % fail instead of 8 %).
void searchLine(const ScaledProblem& problem, const Centre& centre, const NewtonStep& newton, double tolerance,
                SolverScratch& scratch, const Iterate& current, Iterate& trial) {
  const auto attempt = [&](double t) {
    spend(costOfLook(problem), scratch);
    newton.step(t, trial.r);
    evaluate(problem, trial);
    return trial.residual <= tolerance;
  };
  double t = 1;
  if (attempt(t)) return;  // as nearly always from a warm start: |Phi| needn't be known
  const double phi2 = merit(problem, centre, current);
  for (int n = 1; n < kTrials; ++n) {
    if (merit(problem, centre, trial) <= (1 - kSufficientDecrease * t) * phi2) return;
    t *= 0.5;
    if (attempt(t)) return;
  }
}

// True if `current` is the answer with u + epsilon (r - r_c); `u` is working memory.
bool isSolved(const ScaledProblem& problem, const Centre& centre, double tolerance, const Iterate& current, double* u) {
  Iterate given{current.r, u};
  for (int row = 0; row < problem.rowCount(); ++row)
    u[row] = current.u[row] + centre.epsilon * (current.r[row] - centre.r[row]);
  judge(problem, given);
  return given.residual <= tolerance;
}

// Steps of Newton's method; the two iterates swap as they go.
struct Steps {
  const ScaledProblem& problem;
  const double tolerance;
  ContactEquations& equations;
  SolverScratch& scratch;
  Iterate &current, &trial;
  int count = 0;

  bool isDone() const { return current.residual <= tolerance || !std::isfinite(current.residual); }

  // False if the equations are singular, or nothing is left to spend.
  bool step(const Centre& centre) {
    NewtonStep newton(problem, current, centre, equations, scratch);
    if (!newton.solve()) return false;
    searchLine(problem, centre, newton, tolerance, scratch, current, trial);
    std::swap(current, trial);
    ++count;
    return true;
  }

  // True if a few of them find the round's answer.
  bool solve(const Centre& centre) {
    for (int n = 0; n < kStepsPerRound; ++n) {
      if (!step(centre)) return false;
      if (isSolved(problem, centre, tolerance, current, trial.u)) return true;
    }
    return false;
  }
};

// Fills scratch.give; returns the largest.
double keepGive(const ScaledProblem& problem, const Centre& centre, const Iterate& current, SolverScratch& scratch) {
  double largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    for (int row = problem.firstRow(i); row < problem.firstRow(i + 1); ++row) {
      const double give = problem.scale[i] * centre.epsilon * (current.r[row] - centre.r[row]);
      scratch.give[static_cast<std::size_t>(row)] = give;
      largest = std::max(largest, std::abs(give));
    }
  }
  return largest;
}

void addGive(const ScaledProblem& problem, const SolverScratch& scratch, Iterate& it) {
  for (int i = 0; i < problem.contactCount(); ++i) {
    for (int row = problem.firstRow(i); row < problem.firstRow(i + 1); ++row)
      it.u[row] += scratch.give[static_cast<std::size_t>(row)] / problem.scale[i];
  }
  judge(problem, it);
}

}  // namespace

int iterateNewton(const ScaledProblem& problem, double tolerance, int iterations, ContactEquations& equations,
                  SolverScratch& scratch, Iterate& current, Iterate& trial) {
  Steps steps{problem, tolerance, equations, scratch, current, trial};
  double best = current.residual;
  int patience = kPatience;
  while (patience > 0 && steps.count < iterations && !steps.isDone() && steps.step({})) {
    --patience;
    if (!(current.residual < 0.5 * best)) continue;
    best = current.residual;
    patience = kPatience;
  }
  return steps.count;
}

int iterateGiving(const ScaledProblem& problem, double tolerance, int rounds, ContactEquations& equations,
                  SolverScratch& scratch, Iterate& current, Iterate& trial, double& largest) {
  double* const r_c = scratch.shift_centre.data();
  double epsilon = kGivingEpsilon, give = std::numeric_limits<double>::infinity();
  Steps steps{problem, tolerance, equations, scratch, current, trial};
  for (int round = 0; round < rounds && scratch.operations_left >= 0; ++round) {
    std::copy(current.r, current.r + problem.rowCount(), r_c);
    const Centre centre{r_c, epsilon};
    if (steps.solve(centre)) {
      const double before = give;
      give = keepGive(problem, centre, current, scratch);
      if (give <= largest && !(give < kFadesStill * before)) break;
    } else {
      std::copy(r_c, r_c + problem.rowCount(), current.r);
      evaluate(problem, current);
      if (std::isfinite(give)) break;
      epsilon *= kMoreEpsilon;
    }
  }
  largest = give;
  if (std::isfinite(give)) addGive(problem, scratch, current);
  return steps.count;
}

bool iterateSoftly(const ScaledProblem& problem, double tolerance, ContactEquations& equations, SolverScratch& scratch,
                   Iterate& current, Iterate& trial, int& steps) {
  double* const r_c = scratch.shift_centre.data();
  std::fill(r_c, r_c + problem.rowCount(), 0.0);
  Steps newton{problem, tolerance, equations, scratch, current, trial};
  bool is_soft = false;
  for (const double epsilon : kSoftEpsilons) {
    std::fill(current.r, current.r + problem.rowCount(), 0.0);
    evaluate(problem, current);
    is_soft = newton.solve({r_c, epsilon});
    if (is_soft) break;
  }
  steps += newton.count;
  return is_soft;
}

}  // namespace pincer::engine
