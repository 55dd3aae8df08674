#include "pincer/engine/solve/proximal_round.h"

#include <algorithm>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/mobility.h"

namespace pincer::engine {
namespace {

constexpr double kRoundTolerance = 1e-3;  // of |y - A^T r| at a round's start
constexpr double kNearlyFlat =
    0.1;  // of the slope at the start: of the energy, where a step ends; of a bracket, how near its ends a trial comes
constexpr int kMostDoublings = 2, kMostTrials = 8;  // of a step's length

}  // namespace

void ProximalRound::freeze() {
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const double slip2 = tangentNorm2(scratch_.u.data() + problem_.firstRow(i), problem_.rows(i));
    scratch_.frozen[static_cast<std::size_t>(i)] = problem_.friction(i) * std::sqrt(slip2);
  }
}

// Fills scratch.r and scratch.gradient, A^T r - y; returns |gradient|^2.
double ProximalRound::gradient() {
  double* const g = scratch_.gradient.data();
  const double *const y = scratch_.y.data(), *const u = scratch_.u.data(), *const r_c = scratch_.centre.data();
  double* const r = scratch_.r.data();
  for (int j = 0; j < size(); ++j) g[j] = -y[j];
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    const double inverse_e = inverseE(i);
    withRows(problem_.rows(i), [&](auto rows) {
      double* const r_i = r + first;
      for (int k = 0; k < rows; ++k) r_i[k] = r_c[first + k] - u[first + k] * inverse_e;
      if (shift_ == Shift::kFrozen) {
        r_i[kNormalRow] -= frozenShift(i) * inverse_e;
        projectOntoCone(r_i, rows, problem_.friction(i), r_i);
      } else {
        limitFriction(r_i, rows, problem_.friction(i));
      }
      if (r_i[kNormalRow] > 0) addImpulse(problem_.sidesOf(i), rows, r_i, g);
    });
  }
  double norm2 = 0;
  for (int j = 0; j < size(); ++j) norm2 += g[j] * g[j];
  return norm2;
}

// Overwrites scratch.change.
bool ProximalRound::isLeftBelow(double speed) {
  constexpr double kNone[kMaxContactRows] = {};  // q: of the change alone, not of what moves anyway
  double* const left = scratch_.change.data();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    velocityOf(problem_.sidesOf(i), problem_.rows(i), kNone, scratch_.gradient.data(), left + first);
    for (int row = first; row < problem_.firstRow(i + 1); ++row) {
      if (!(std::abs(left[row]) <= speed)) return false;
    }
  }
  return true;
}

void ProximalRound::addToMatrix(int i, int rows, const double* x) {
  const double inverse_e = inverseE(i);
  const ContactMode mode = contactMode(x, rows, problem_.friction(i));
  if (mode == ContactMode::kOpen) return matrix_.skip(i);
  if (mode == ContactMode::kStick) return matrix_.addScaled(i, inverse_e);
  const SlideDerivative slide = slideDerivative(x, rows, problem_.friction(i));
  double G[kMaxContactRows][kMaxContactRows];
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) G[k][l] = inverse_e * slide.at(k, l);
  }
  matrix_.add(i, G);
}

void ProximalRound::addFrozenToMatrix(int i, int rows, const double* x) {
  const double inverse_e = inverseE(i), mu = problem_.friction(i), n = x[kNormalRow], t2 = tangentNorm2(x, rows);
  if (n > 0 && t2 <= mu * mu * n * n) return matrix_.addScaled(i, inverse_e);
  if (n <= 0 && mu * mu * t2 <= n * n) return matrix_.skip(i);
  double G[kMaxContactRows][kMaxContactRows];
  rimDerivative(x, rows, mu, G);
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l) G[k][l] *= inverse_e;
  }
  matrix_.add(i, G);
}

// Newton's direction from scratch.gradient, and by how much u changes along it.
bool ProximalRound::step() {
  matrix_.clear();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i), rows = problem_.rows(i);
    const double inverse_e = inverseE(i);
    double x[kMaxContactRows] = {};
    for (int k = 0; k < rows; ++k)
      x[k] = scratch_.centre[static_cast<std::size_t>(first + k)] -
             scratch_.u[static_cast<std::size_t>(first + k)] * inverse_e;
    x[kNormalRow] -= frozenShift(i) * inverse_e;
    shift_ == Shift::kFrozen ? addFrozenToMatrix(i, rows, x) : addToMatrix(i, rows, x);
  }
  if (!matrix_.factorise()) return false;
  double* const d = scratch_.direction.data();
  std::copy(scratch_.gradient.data(), scratch_.gradient.data() + size(), d);
  matrix_.solve(d);
  double* const change = scratch_.change.data();
  for (int i = 0; i < problem_.contactCount(); ++i) {
    const int first = problem_.firstRow(i);
    withRows(problem_.rows(i), [&](auto rows) {
      constexpr double kNone[kMaxContactRows] = {};  // q, as in isLeftBelow
      velocityOf(problem_.sidesOf(i), rows, kNone, d, change + first);
    });
  }
  return true;
}

void ProximalRound::move(double t) {
  for (int j = 0; j < size(); ++j)
    scratch_.y[static_cast<std::size_t>(j)] += t * scratch_.direction[static_cast<std::size_t>(j)];
  for (int row = 0; row < problem_.rowCount(); ++row)
    scratch_.u[static_cast<std::size_t>(row)] += t * scratch_.change[static_cast<std::size_t>(row)];
}

// Halves the step until the gradient falls enough. If it never does the shortest step is taken all the same: that
// leaves the cycles and corners where insisting on descent gets stuck.
double ProximalRound::searchLine(double merit) {
  double t = 1, taken = 0, next = merit;
  for (int trial = 0; trial < kTrials; ++trial, t *= 0.5) {
    move(t - taken);
    taken = t;
    next = gradient();
    if (next <= (1 - kSufficientDecrease * t) * merit) break;
  }
  return next;
}

// Of the energy along the direction.
double ProximalRound::slope() const {
  double sum = 0;
  for (int j = 0; j < size(); ++j)
    sum -= scratch_.gradient[static_cast<std::size_t>(j)] * scratch_.direction[static_cast<std::size_t>(j)];
  return sum;
}

// To where the energy is nearly least along the direction: by doubling until it rises, then by
// false position, kept away from the ends.
double ProximalRound::minimise() {
  const double steep = slope(), flat = kNearlyFlat * std::abs(steep);
  double low = 0, low_slope = steep, high = 1, taken = 0, merit = 0;
  const auto slopeAt = [&](double t) {
    move(t - taken);
    taken = t;
    merit = gradient();
    return slope();
  };
  double high_slope = slopeAt(high);
  for (int n = 0; n < kMostDoublings && high_slope < -flat; ++n) {
    low = high;
    low_slope = high_slope;
    high_slope = slopeAt(high *= 2);
  }
  for (int n = 0; n < kMostTrials && high_slope > flat; ++n) {
    const double width = high - low, t = (low * high_slope - high * low_slope) / (high_slope - low_slope);
    const double at = std::clamp(t, low + kNearlyFlat * width, high - kNearlyFlat * width), at_slope = slopeAt(at);
    if (std::abs(at_slope) <= flat) break;
    (at_slope > 0 ? high : low) = at;
    (at_slope > 0 ? high_slope : low_slope) = at_slope;
  }
  return merit;
}

bool ProximalRound::solve(Shift shift, const Limits& limits, int& steps) {
  shift_ = shift;
  epsilon_ = limits.epsilon;
  if (shift == Shift::kFrozen) freeze();
  double merit = gradient();
  const double enough = kRoundTolerance * kRoundTolerance * merit;
  for (int n = 0; n < limits.steps; ++n) {
    if (merit == 0 || (n > 0 && merit <= enough && isLeftBelow(limits.left))) return true;
    if (!std::isfinite(merit) || !step()) return false;
    ++steps;
    merit = shift == Shift::kFrozen ? minimise() : searchLine(merit);
  }
  return merit <= enough;
}

}  // namespace pincer::engine
