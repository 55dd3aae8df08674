// mobility: products with A, the factor of the Delassus operator W = A A^T (contact_problem.h), contact by contact.
//
//   y = A^T r   movers' scaled velocity changes, y_b = M_b^1/2 dv_b [sqrt(J)], kMoverFreedoms per mover;   W r = A y
//
// Linear in the number of contacts, whatever the number of pairs of them that see each other. Sums in a fixed order.
#pragma once
#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

// Two sums at once, of what is even and what is odd: left to itself the compiler does one after the
// other. (`auto` would forget the alignment.)
using DoublePair [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
[[gnu::always_inline]] inline DoublePair dotPair6(const double* a, const double* b) {
  const DoublePair *const x = reinterpret_cast<const DoublePair*>(a), *const y = reinterpret_cast<const DoublePair*>(b);
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}
[[gnu::always_inline]] inline double dot6(const double* a, const double* b) {
  const auto sum = dotPair6(a, b);
  return sum[0] + sum[1];
}

// The same where the last three are 0.
[[gnu::always_inline]] inline double dot3(const double* a, const double* b) {
  return (a[0] * b[0] + a[2] * b[2]) + a[1] * b[1];
}

// y += A_i^T r_i
inline void addImpulse(std::span<const ContactSide> sides, int rows, const double* r, double* y) {
  withRows(rows, [&](auto count) {
    for (const ContactSide& side : sides) {
      if (side.mover < 0) continue;
      double* const y_b = y + kMoverFreedoms * side.mover;
      double sum[kMoverFreedoms];  // the compiler can't know that y isn't A
      for (int j = 0; j < kMoverFreedoms; ++j) sum[j] = y_b[j];
      for (int k = 0; k < count; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j) sum[j] += side.A[k][j] * r[k];
      }
      for (int j = 0; j < kMoverFreedoms; ++j) y_b[j] = sum[j];
    }
  });
}

// u_i += A_i y
inline void addVelocity(std::span<const ContactSide> sides, int rows, const double* y, double* u) {
  withRows(rows, [&](auto count) {
    for (const ContactSide& side : sides) {
      if (side.mover < 0) continue;
      const double* const y_b = y + kMoverFreedoms * side.mover;
      for (int k = 0; k < count; ++k) u[k] += dot6(side.A[k], y_b);
    }
  });
}

// block (row-major, `stride` per row) += A_ib A_jb^T, for one mover b that contacts i and j both touch.
inline void addCoupling(const ContactSide& i, int rows, const ContactSide& j, int columns, double* block, int stride) {
  withRows(rows, [&](auto row_count) {
    withRows(columns, [&](auto column_count) {
      for (int k = 0; k < row_count; ++k) {
        for (int l = 0; l < column_count; ++l) block[k * stride + l] += dot6(i.A[k], j.A[l]);
      }
    });
  });
}

// u_i = A_i y + q_i
inline void velocityOf(std::span<const ContactSide> sides, int rows, const double* q, const double* y, double* u) {
  withRows(rows, [&](auto count) {
    DoublePair sum[kMaxContactRows] = {};
    for (const ContactSide& side : sides) {
      if (side.mover < 0) continue;
      for (int k = 0; k < count; ++k) sum[k] += dotPair6(side.A[k], y + kMoverFreedoms * side.mover);
    }
    for (int k = 0; k < count; ++k) u[k] = q[k] + (sum[k][0] + sum[k][1]);
  });
}

// The same of the normal row alone.
inline double normalVelocityOf(std::span<const ContactSide> sides, double q_n, const double* y) {
  double u = q_n;
  for (const ContactSide& side : sides) {
    if (side.mover >= 0) u += dot6(side.A[kNormalRow], y + kMoverFreedoms * side.mover);
  }
  return u;
}

}  // namespace pincer::engine
