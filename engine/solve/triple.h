// triple: three numbers and 3 x 3 matrices of them, in line: Eigen's products of that size are calls here.
#pragma once
#include <algorithm>
#include <cmath>

#include "pincer/contact/math.h"
#include "pincer/engine/solve/lanes.h"

namespace pincer::engine {

struct Triple {
  double x[3];
  double& operator[](int k) { return x[k]; }
  double operator[](int k) const { return x[k]; }
};
inline double dot(const Triple& a, const Triple& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

struct Matrix3 {
  double column[3][3];
  void operator=(const Mat3& M) { std::copy(M.data(), M.data() + 9, column[0]); }
  Triple operator*(const Triple& v) const {
    Triple out;
    times<3>([&](auto i) { out[i] = (column[0][i] * v[0] + column[1][i] * v[1]) + column[2][i] * v[2]; });
    return out;
  }
  Triple transposeTimes(const Triple& v) const {
    Triple out;
    times<3>([&](auto k) { out[k] = (column[k][0] * v[0] + column[k][1] * v[1]) + column[k][2] * v[2]; });
    return out;
  }
};

// Symmetric: xx, yy, zz, xy, xz, yz.
struct Symmetric3 {
  double s[6];
  Triple operator*(const Triple& v) const {
    return {{(s[0] * v[0] + s[3] * v[1]) + s[4] * v[2], (s[3] * v[0] + s[1] * v[1]) + s[5] * v[2],
             (s[4] * v[0] + s[5] * v[1]) + s[2] * v[2]}};
  }
  double trace() const { return (s[0] + s[1]) + s[2]; }
  void add(const Symmetric3& other, double factor) {
    times<6>([&](auto k) { s[k] += factor * other.s[k]; });
  }
  // tr(S) I - S
  Symmetric3 turning() const {
    const double t = trace();
    return {{t - s[0], t - s[1], t - s[2], -s[3], -s[4], -s[5]}};
  }
  // F^T S F
  Symmetric3 within(const Matrix3& F) const {
    Triple f[3], Sf[3];
    times<3>([&](auto k) {
      f[k] = {{F.column[k][0], F.column[k][1], F.column[k][2]}};
      Sf[k] = *this * f[k];
    });
    return {
        {dot(f[0], Sf[0]), dot(f[1], Sf[1]), dot(f[2], Sf[2]), dot(f[0], Sf[1]), dot(f[0], Sf[2]), dot(f[1], Sf[2])}};
  }
};
inline Symmetric3 squareOf(const Triple& a) {
  return {{a[0] * a[0], a[1] * a[1], a[2] * a[2], a[0] * a[1], a[0] * a[2], a[1] * a[2]}};
}
// sum += a x b
inline void addCross(const Triple& a, const Triple& b, Triple& sum) {
  times<3>([&](auto k) {
    constexpr int j = (k + 1) % 3, l = (k + 2) % 3;
    sum[k] += a[j] * b[l] - a[l] * b[j];
  });
}

// L D L^T of the body's N, whose N_ll is diagonal.
class BodyFactor {
 public:
  // False if a pivot isn't positive and finite.
  //   N_la  row by row
  bool factorise(const Triple& N_ll, const Triple (&N_la)[3], Symmetric3 N_aa) {
    for (int k = 0; k < 3; ++k) {
      inverse_ll_[k] = 1 / N_ll[k];
      times<3>([&](auto j) { U_[k][j] = inverse_ll_[k] * N_la[k][j]; });
      Symmetric3 outer{{U_[k][0] * N_la[k][0], U_[k][1] * N_la[k][1], U_[k][2] * N_la[k][2], U_[k][0] * N_la[k][1],
                        U_[k][0] * N_la[k][2], U_[k][1] * N_la[k][2]}};
      N_aa.add(outer, -1);
    }
    const double* const s = N_aa.s;
    const double d0 = s[0];
    l10_ = s[3] / d0;
    l20_ = s[4] / d0;
    const double d1 = s[1] - l10_ * s[3], e = s[5] - l20_ * s[3];
    l21_ = e / d1;
    const double d2 = (s[2] - l20_ * s[4]) - l21_ * e;
    inverse_aa_ = {{1 / d0, 1 / d1, 1 / d2}};
    return isPivot(d0) && isPivot(d1) && isPivot(d2) && isPivot(N_ll[0]) && isPivot(N_ll[1]) && isPivot(N_ll[2]);
  }
  void solve(Triple& l, Triple& a) const {
    for (int k = 0; k < 3; ++k) times<3>([&](auto j) { a[j] -= U_[k][j] * l[k]; });
    a[1] -= l10_ * a[0];
    a[2] -= l20_ * a[0] + l21_ * a[1];
    times<3>([&](auto k) { a[k] *= inverse_aa_[k]; });
    a[1] -= l21_ * a[2];
    a[0] -= l10_ * a[1] + l20_ * a[2];
    times<3>([&](auto k) { l[k] = inverse_ll_[k] * l[k] - dot(U_[k], a); });
  }

 private:
  static bool isPivot(double x) { return x > 0 && std::isfinite(x); }

  Triple inverse_ll_, inverse_aa_, U_[3];
  double l10_, l20_, l21_;
};

}  // namespace pincer::engine
