// lorentz: the Lorentz cone L = { v : |v_T| <= v_n } and its Jordan algebra, on contact
// vectors (t1, t2, n[, tau[, rho1, rho2]]).
//
//   a o b = (a_n b_T + b_n a_T, a . b),   e = (0, 0, 1[, 0 ..]),   det v = v_n^2 - |v_T|^2
//
// Source: F. Alizadeh, D. Goldfarb, "Second-order cone programming", Math. Program. 95 (2003) 3-51, section 4;
// Nesterov-Todd scaling: L. Vandenberghe, "The CVXOPT linear and quadratic cone program solvers" (2010).
#pragma once
#include <algorithm>
#include <cmath>

#include "pincer/engine/solve/cone.h"

namespace pincer::engine {

// sqrt(det v) of a v inside L; by factors, because near the boundary the squares cancel.
[[gnu::always_inline]] inline double lorentzNorm(const double* v, int rows) {
  const double vT = std::sqrt(tangentNorm2(v, rows));
  return std::sqrt(std::max((v[kNormalRow] - vT) * (v[kNormalRow] + vT), 0.0));
}

[[gnu::always_inline]] inline void jordanProduct(const double* a, const double* b, int rows, double* ab) {
  const double a_n = a[kNormalRow];
  const double b_n = b[kNormalRow];
  const double normal = tangentDot(a, b, rows) + a_n * b_n;
  for (int k = 0; k < rows; ++k) ab[k] = a_n * b[k] + b_n * a[k];
  ab[kNormalRow] = normal;
}

// x with a o x = b; a inside L.
[[gnu::always_inline]] inline void jordanDivide(const double* a, const double* b, int rows, double* x) {
  const double a_n = a[kNormalRow];
  const double norm = lorentzNorm(a, rows);
  const double normal = (a_n * b[kNormalRow] - tangentDot(a, b, rows)) / (norm * norm);
  for (int k = 0; k < rows; ++k) x[k] = (b[k] - normal * a[k]) / a_n;
  x[kNormalRow] = normal;
}

// The largest step t <= 1e3 with v + t dv in L, from a v inside it.
double stepToBoundary(const double* v, const double* dv, int rows);

// Nesterov-Todd scaling N = beta (2 v v^T - J), J = diag(-1, -1, 1[, -1]): symmetric, maps L onto itself, N x = N^-1 z.
struct NesterovTodd {
  double v[kMaxContactRows];
  double beta;

  NesterovTodd(const double* x, const double* z, int rows);
  void apply(const double* a, int rows, double* Na) const;
  void applyInverse(const double* a, int rows, double* Na) const;
};

[[gnu::always_inline]] inline NesterovTodd::NesterovTodd(const double* x, const double* z, int rows) {
  const double x_norm = lorentzNorm(x, rows);
  const double z_norm = lorentzNorm(z, rows);
  beta = std::sqrt(z_norm / x_norm);
  const double cosine = (tangentDot(x, z, rows) + x[kNormalRow] * z[kNormalRow]) / (x_norm * z_norm);
  const double inverse = 1 / (2 * std::sqrt(0.5 * (1 + cosine)));
  for (int k = 0; k < rows; ++k) v[k] = (z[k] / z_norm - x[k] / x_norm) * inverse;
  v[kNormalRow] = (z[kNormalRow] / z_norm + x[kNormalRow] / x_norm) * inverse + 1;
  const double half = 1 / std::sqrt(2 * v[kNormalRow]);
  for (int k = 0; k < rows; ++k) v[k] *= half;
}

[[gnu::always_inline]] inline void NesterovTodd::apply(const double* a, int rows, double* Na) const {
  const double along = 2 * (tangentDot(v, a, rows) + v[kNormalRow] * a[kNormalRow]);
  const double normal = beta * (along * v[kNormalRow] - a[kNormalRow]);
  for (int k = 0; k < rows; ++k) Na[k] = beta * (along * v[k] + a[k]);
  Na[kNormalRow] = normal;
}

[[gnu::always_inline]] inline void NesterovTodd::applyInverse(const double* a, int rows, double* Na) const {
  const double along = 2 * (v[kNormalRow] * a[kNormalRow] - tangentDot(v, a, rows));
  const double normal = (along * v[kNormalRow] - a[kNormalRow]) / beta;
  for (int k = 0; k < rows; ++k) Na[k] = (a[k] - along * v[k]) / beta;
  Na[kNormalRow] = normal;
}

}  // namespace pincer::engine
