// cone: the Coulomb cone, for contact vectors of three to six rows.
//
//   K_mu = { r : |r_T| <= mu r_n },   r = (r_t1, r_t2, r_n[, r_tau[, r_rho1, r_rho2]]),   r_T = r without r_n
//
//   r    impulse [N s], velocity [m/s] or anything in proportion to them, in the
//        contact frame C, whose third axis is the normal
//   mu   friction coefficient [-], 0 <= mu < inf; 0 gives the half-line r_T = 0, r_n >= 0
// Nothing here can fail; what isn't finite on entry isn't finite, or isn't inside, on return.
// Sources: projection onto a second-order cone: F. Alizadeh, D. Goldfarb, Math. Program. 95 (2003) 3-51. The
// two coupled projections (normal first, then a disc whose radius follows it): P. Alart, A. Curnier, Comput.
// Methods Appl. Mech. Engrg. 92 (1991) 353-375.
#pragma once
#include <cmath>

#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

// The row of the k-th tangential component; k = 0, 1, with torsion 2, with rolling 3 and 4.
constexpr int tangentRow(int k) { return k < kNormalRow ? k : k + 1; }

// Of torsion and rolling.
[[gnu::always_inline]] inline double angularDot(const double* a, const double* b, int rows) {
  double sum = a[kTorsionRow] * b[kTorsionRow];
  for (int k = kRollingRow; k < rows; ++k) sum += a[k] * b[k];
  return sum;
}

[[gnu::always_inline]] inline double tangentNorm2(const double* v, int rows) {
  const double planar = v[0] * v[0] + v[1] * v[1];
  return rows == 3 ? planar : planar + angularDot(v, v, rows);
}

[[gnu::always_inline]] inline double tangentDot(const double* a, const double* b, int rows) {
  const double planar = a[0] * b[0] + a[1] * b[1];
  return rows == 3 ? planar : planar + angularDot(a, b, rows);
}

// |r_T| <= (1 + slack) mu r_n.
inline bool isInCone(const double* r, int rows, double mu, double slack = 0) {
  const double radius = (1 + slack) * mu * r[kNormalRow];
  return r[kNormalRow] >= 0 && tangentNorm2(r, rows) <= radius * radius;
}

[[gnu::always_inline]] inline void setVector(double* v, int rows, double tangent_scale, const double* direction,
                                             double normal) {
  for (int k = 0; k < rows; ++k) v[k] = tangent_scale * direction[k];
  v[kNormalRow] = normal;
}

// p = the point of K_mu closest to y. p may be y itself.
[[gnu::always_inline]] inline void projectOntoCone(const double* y, int rows, double mu, double* p) {
  const double yT2 = tangentNorm2(y, rows), yn = y[kNormalRow], radius = mu * yn;
  if (yn > 0 && yT2 <= radius * radius) return setVector(p, rows, 1, y, yn);  // inside, mostly: no root
  const double yT = std::sqrt(yT2);
  // in the polar cone; asked first: a pull without friction has yT = mu yn = 0
  if (mu * yT <= -yn) return setVector(p, rows, 0, y, 0);
  const double normal = (yn + mu * yT) / (1 + mu * mu);  // yT > 0 here: the cases above cover yT = 0
  setVector(p, rows, mu * normal / yT, y, normal);
}

// r becomes Alart and Curnier's coupled projections of it: r_n = max(0, r_n), then r_T put into the disc of radius
// mu r_n. Returns how much friction was missing of |r_T|, if it pushes.
template <class Rows>
[[gnu::always_inline]] inline double limitFriction(double* r, Rows rows, double mu) {
  const double n = r[kNormalRow], most = mu * n;
  if (!(n > 0)) {
    for (int k = 0; k < rows; ++k) r[k] = 0;
    return 0;
  }
  const double t2 = tangentNorm2(r, rows);
  if (!(t2 > most * most)) return 0;
  const double t = std::sqrt(t2), share = most / t;
  for (int k = 0; k < rows; ++k) r[k] *= share;
  r[kNormalRow] = n;
  return t - most;
}

// The three ways in which Alart and Curnier's coupled projections act on y: off (y_n <= 0), inside
// the disc of radius mu y_n, or onto its rim.
enum class ContactMode : unsigned char { kOpen, kStick, kSlide };

[[gnu::always_inline]] inline ContactMode contactMode(const double* y, int rows, double mu) {
  const double yn = y[kNormalRow];
  if (!(yn > 0)) return ContactMode::kOpen;
  return tangentNorm2(y, rows) <= mu * mu * yn * yn ? ContactMode::kStick : ContactMode::kSlide;
}

// Derivative D of the coupled projections of a sliding y:
//   dp_T = s (I - t t^T) dy_T + mu t dy_n,  dp_n = dy_n,  t = y_T / |y_T|,  s = mu y_n / |y_T|
struct SlideDerivative {
  double t[kMaxContactRows];  // [-]; its normal row is 0
  double s;                   // [-], 0 <= s < 1
  double mu;                  // [-]

  double at(int k, int l) const {
    if (l == kNormalRow) return k == kNormalRow ? 1 : mu * t[k];
    return (k == l ? s : 0) - s * t[k] * t[l];
  }
};

[[gnu::always_inline]] inline SlideDerivative slideDerivative(const double* y, int rows, double mu) {
  const double inverse = 1 / std::sqrt(tangentNorm2(y, rows));
  SlideDerivative d{};
  setVector(d.t, rows, inverse, y, 0);
  d.s = mu * y[kNormalRow] * inverse;
  d.mu = mu;
  return d;
}

// Derivative D of the projection onto K_mu of a y outside of it and of its polar cone; symmetric:
//   D = z z^T / (1 + mu^2) + mu (p_n / |y_T|) (I_T - t t^T),  I_T  the identity but for the normal row
//   t = y_T / |y_T|,  z = mu t + e_n,  p_n = (y_n + mu |y_T|) / (1 + mu^2)
[[gnu::always_inline]] inline void rimDerivative(const double* y, int rows, double mu,
                                                 double (&D)[kMaxContactRows][kMaxContactRows]) {
  const double yT = std::sqrt(tangentNorm2(y, rows)), inverse = 1 / (1 + mu * mu),
               bend = mu * (y[kNormalRow] + mu * yT) * inverse / yT;
  double t[kMaxContactRows], z[kMaxContactRows];
  setVector(t, rows, 1 / yT, y, 0);
  setVector(z, rows, mu / yT, y, 1);
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < rows; ++l)
      D[k][l] = inverse * z[k] * z[l] + bend * ((k == l && k != kNormalRow ? 1 : 0) - t[k] * t[l]);
  }
}

template <class Rows>
[[gnu::always_inline]] inline double naturalMap2Of(Rows rows, const double* r, const double* u, double mu, double w) {
  double y[kMaxContactRows] = {}, p[kMaxContactRows], sum = 0;
  for (int k = 0; k < rows; ++k) y[k] = w * r[k] - u[k];
  y[kNormalRow] -= mu * std::sqrt(tangentNorm2(u, rows));
  projectOntoCone(y, rows, mu, p);
  for (int k = 0; k < rows; ++k) sum += (w * r[k] - p[k]) * (w * r[k] - p[k]);
  return sum;
}

// Squared natural map |w r - P_K(w r - u~)|^2 of the frictional contact law, u~ = u + mu
// |u_T| e_n; 0 iff r and u obey it [(m/s)^2].
//   w  > 0: scale that turns impulses into velocities [1/kg]. K is a cone, so w P_K(y) = P_K(w y): no division.
inline double naturalMap2(const double* r, const double* u, int rows, double mu, double w) {
  double sum = 0;
  withRows(rows, [&](auto count) { sum = naturalMap2Of(count, r, u, mu, w); });
  return sum;
}

}  // namespace pincer::engine
