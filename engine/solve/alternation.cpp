#include "pincer/engine/solve/alternation.h"

#include <algorithm>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {

bool Alternation::factorise() {
  if (factored_ == rho_) return true;
  matrix_.clear();
  for (int i = 0; i < problem_.contactCount(); ++i) matrix_.addScaled(i, 1 / (rho_ * scratch_.weight[static_cast<std::size_t>(i)]));
  factored_ = matrix_.factorise() ? rho_ : 0;
  return factored_ != 0;
}

bool Alternation::run(int steps, bool resume) {
  constexpr std::int64_t kPerContact = 250;
  if (!resume) {
    for (int row = 0; row < problem_.rowCount(); ++row)
      scratch_.multiplier[static_cast<std::size_t>(row)] = -scratch_.u[static_cast<std::size_t>(row)];
    factored_ = 0;
  }
  if (!factorise()) return false;
  for (int n = 0; n < steps && spend(kPerContact * problem_.contactCount() + matrix_.costOfSolution(), scratch_); ++n) takeStep();
  adapt();
  return scratch_.operations_left >= 0;
}

void Alternation::takeStep() {
  const double* const q = problem_.q.data();
  double *const b = scratch_.work.data(), *const l = scratch_.multiplier.data(), *const z = scratch_.centre.data(),
                *const y = scratch_.direction.data();
  std::fill(y, y + kMoverFreedoms * problem_.movers, 0.0);
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    const double inverse = 1 / (rho_ * scratch_.weight[static_cast<std::size_t>(i)]);
    withRows(problem_.rows(i), [&](auto rows) {
      double* const b_i = b + first;
      for (int k = 0; k < rows; ++k) b_i[k] = z[first + k] - (q[first + k] + l[first + k]) * inverse;
      b_i[kNormalRow] -= problem_.friction(i) * std::sqrt(tangentNorm2(l + first, rows)) * inverse;
      addImpulse(problem_.sidesOf(i), rows, b_i, y);
    });
  }
  matrix_.solve(y);
  primal_ = dual_ = 0;
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    const double c = rho_ * scratch_.weight[static_cast<std::size_t>(i)], inverse = 1 / c;
    withRows(problem_.rows(i), [&](auto rows) {
      constexpr double kNone[kMaxContactRows] = {};
      double x[kMaxContactRows], v[kMaxContactRows], inside[kMaxContactRows];
      velocityOf(problem_.sidesOf(i), rows, kNone, y, x);
      for (int k = 0; k < rows; ++k) {
        x[k] = b[first + k] - x[k] * inverse;
        v[k] = x[k] + l[first + k] * inverse;
      }
      projectOntoCone(v, rows, problem_.friction(i), inside);
      for (int k = 0; k < rows; ++k) {
        const double gap = x[k] - inside[k];
        l[first + k] += c * gap;
        primal_ = std::max(primal_, scratch_.weight[static_cast<std::size_t>(i)] * std::abs(gap));
        dual_ = std::max(dual_, c * std::abs(inside[k] - z[first + k]));
        z[first + k] = inside[k];
      }
    });
  }
}

// A larger rho brings r and z together, a smaller one lets them move.
void Alternation::adapt() {
  constexpr double kUnequal = 10, kFactor = 4, kLeast = 1e-6, kMost = 1e3;
  if (primal_ > kUnequal * dual_) rho_ = std::min(kMost, kFactor * rho_);
  if (dual_ > kUnequal * primal_) rho_ = std::max(kLeast, rho_ / kFactor);
}

}  // namespace pincer::engine
