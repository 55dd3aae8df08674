#include "pincer/engine/solve/proximal_round.h"

#include <algorithm>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {
namespace {

constexpr double kRoundTolerance = 1e-3;   // of |y - A^T r| at a round's start
constexpr int kRoundTrials = 6;            // step lengths 1, 1/2, .. 1/32
constexpr double kRoundSufficient = 1e-4;  // Armijo's

// r = C(x), x overwritten.
template <class Rows>
[[gnu::always_inline]] inline void applyLaw(double* x, Rows rows, double mu) {
  const double most = mu * x[kNormalRow], n = x[kNormalRow];
  if (!(n > 0)) {
    for (int k = 0; k < rows; ++k) x[k] = 0;
    return;
  }
  const double t2 = tangentNorm2(x, rows);
  if (t2 <= most * most) return;
  const double s = most / std::sqrt(t2);
  for (int k = 0; k < rows; ++k) x[k] *= s;
  x[kNormalRow] = n;
}

}  // namespace

// Fills scratch.r and scratch.gradient; returns |gradient|^2.
double ProximalRound::gradient(double epsilon) {
  double* const g = scratch_.gradient.data();
  const double *const y = scratch_.y.data(), *const u = scratch_.u.data(), *const r_c = scratch_.centre.data();
  double* const r = scratch_.r.data();
  for (int j = 0; j < size(); ++j) g[j] = -y[j];
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    const double inverse_e = 1 / (epsilon * scratch_.weight[static_cast<std::size_t>(i)]);
    withRows(problem_.rows(i), [&](auto rows) {
      double* const r_i = r + first;
      for (int k = 0; k < rows; ++k) r_i[k] = r_c[first + k] - u[first + k] * inverse_e;
      applyLaw(r_i, rows, problem_.friction(i));
      if (r_i[kNormalRow] > 0) addImpulse(problem_.sidesOf(i), rows, r_i, g);
    });
  }
  double norm2 = 0;
  for (int j = 0; j < size(); ++j) norm2 += g[j] * g[j];
  return norm2;
}

// Newton's direction from scratch.gradient (which is minus that of above), and by how much u changes along it.
bool ProximalRound::step(double epsilon) {
  matrix_.clear();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i), rows = problem_.rows(i);
    const double inverse_e = 1 / (epsilon * scratch_.weight[static_cast<std::size_t>(i)]);
    double x[kMaxContactRows] = {};
    for (int k = 0; k < rows; ++k)
      x[k] = scratch_.centre[static_cast<std::size_t>(first + k)] - scratch_.u[static_cast<std::size_t>(first + k)] * inverse_e;
    const ContactMode mode = contactMode(x, rows, problem_.friction(i));
    if (mode == ContactMode::kOpen) {
      matrix_.skip(i);
    } else if (mode == ContactMode::kStick) {
      matrix_.addScaled(i, inverse_e);
    } else {
      const SlideDerivative slide = slideDerivative(x, rows, problem_.friction(i));
      double G[kMaxContactRows][kMaxContactRows];
      for (int k = 0; k < rows; ++k) {
        for (int l = 0; l < rows; ++l) G[k][l] = inverse_e * slide.at(k, l);
      }
      matrix_.add(i, G);
    }
  }
  if (!matrix_.factorise()) return false;
  double* const d = scratch_.direction.data();
  std::copy(scratch_.gradient.data(), scratch_.gradient.data() + size(), d);
  matrix_.solve(d);
  double* const change = scratch_.change.data();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    withRows(problem_.rows(i), [&](auto rows) {
      constexpr double kNone[kMaxContactRows] = {};
      velocityOf(problem_.sidesOf(i), rows, kNone, d, change + first);
    });
  }
  return true;
}

void ProximalRound::move(double t) {
  for (int j = 0; j < size(); ++j) scratch_.y[static_cast<std::size_t>(j)] += t * scratch_.direction[static_cast<std::size_t>(j)];
  for (int row = 0; row < problem_.rowCount(); ++row)
    scratch_.u[static_cast<std::size_t>(row)] += t * scratch_.change[static_cast<std::size_t>(row)];
}

// Halves the step until the gradient falls enough. If it never does the shortest step is taken all the same: that leaves the cycles and corners where
// insisting on descent gets stuck.
double ProximalRound::searchLine(double epsilon, double merit) {
  double t = 1, taken = 0, next = merit;
  for (int trial = 0; trial < kRoundTrials; ++trial, t *= 0.5) {
    move(t - taken);
    taken = t;
    next = gradient(epsilon);
    if (next <= (1 - kRoundSufficient * t) * merit) break;
  }
  return next;
}

bool ProximalRound::solve(double epsilon, int most_steps, int& steps) {
  double merit = gradient(epsilon);
  const double enough = kRoundTolerance * kRoundTolerance * merit;
  for (int n = 0; n < most_steps; ++n) {
    if (merit == 0 || (n > 0 && merit <= enough)) return true;
    if (!std::isfinite(merit) || !step(epsilon)) return false;
    ++steps;
    merit = searchLine(epsilon, merit);
  }
  return merit <= enough;
}

}  // namespace pincer::engine
