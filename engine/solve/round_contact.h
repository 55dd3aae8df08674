// round_contact: a contact whose points lie on its bodies' normals through their centres, as between balls: 16 numbers,
// two lines of the cache, say what A's 36 do.
//
//   u = A y + q = R^T (dv + dw x n) + q,   dv = sum_b linear_b y_b(1..3),   dw = sum_b turn_b y_b(4..6)
//   A^T r:  f = R r,  (linear_b f, turn_b n x f)
//
//   R       columns (t1, t2, n), all three turned round where only the second body moves
//   linear  M_b^-1/2, with its sign [kg^-1/2];   turn  arm times I_b^-1/2, likewise
// To round-off the same as A, along n without what round-off makes of n x n. For heaps,
// whose sweeps wait for memory (sweeps.h).
#pragma once
#include <vector>

#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

// Fills `round`, as large as the contacts at least; what isn't round is marked so. If
// most are, `problem` looks there from now on.
void findRoundContacts(std::vector<RoundContact>& round, ContactProblem& problem);

// velocityOf and the like of mobility.h, of a contact that is round.
[[gnu::always_inline]] inline void velocityOf(const RoundContact& c, int, const double* q, const double* y, double* u) {
  const double *const a = y + kMoverFreedoms * c.mover[0], *const b = y + kMoverFreedoms * c.mover[1];
  double dv[3], dw[3];
  for (int j = 0; j < 3; ++j) {
    dv[j] = c.linear[0] * a[j] + c.linear[1] * b[j];
    dw[j] = c.turn[0] * a[3 + j] + c.turn[1] * b[3 + j];
  }
  const double* const n = c.R[kNormalRow];
  const double slip[3] = {dv[0] + (dw[1] * n[2] - dw[2] * n[1]), dv[1] + (dw[2] * n[0] - dw[0] * n[2]),
                          dv[2] + (dw[0] * n[1] - dw[1] * n[0])};
  for (int k = 0; k < kNormalRow; ++k)
    u[k] = q[k] + ((c.R[k][0] * slip[0] + c.R[k][1] * slip[1]) + c.R[k][2] * slip[2]);
  u[kNormalRow] = q[kNormalRow] + ((n[0] * dv[0] + n[1] * dv[1]) + n[2] * dv[2]);
}
inline double normalVelocityOf(const RoundContact& c, double q_n, const double* y) {
  const double *const a = y + kMoverFreedoms * c.mover[0], *const b = y + kMoverFreedoms * c.mover[1];
  double u = q_n;
  for (int j = 0; j < 3; ++j) u += c.R[kNormalRow][j] * (c.linear[0] * a[j] + c.linear[1] * b[j]);
  return u;
}
[[gnu::always_inline]] inline void addVelocity(const RoundContact& c, int rows, const double* y, double* u) {
  velocityOf(c, rows, u, y, u);
}

[[gnu::always_inline]] inline void addImpulse(const RoundContact& c, int, const double* r, double* y) {
  const double* const n = c.R[kNormalRow];
  double f[3];
  for (int j = 0; j < 3; ++j) f[j] = (c.R[0][j] * r[0] + c.R[1][j] * r[1]) + n[j] * r[kNormalRow];
  const double turning[3] = {n[1] * f[2] - n[2] * f[1], n[2] * f[0] - n[0] * f[2], n[0] * f[1] - n[1] * f[0]};
  for (int side = 0; side < 2; ++side) {
    double* const y_b = y + kMoverFreedoms * c.mover[side];
    for (int j = 0; j < 3; ++j) {
      y_b[j] += c.linear[side] * f[j];
      y_b[3 + j] += c.turn[side] * turning[j];
    }
  }
}

// Calls act with the number of rows, as withRows does, and with what stands for contact i of a
// problem: its RoundContact, or its ContactSides.
template <class Problem, class Act>
[[gnu::always_inline]] inline void withForm(const Problem& problem, int i, const Act& act) {
  const auto place = static_cast<std::size_t>(i);
  if (!problem.round.empty() && problem.round[place].isRound())
    return act(std::integral_constant<int, kTorsionRow>(), problem.round[place]);
  withRows(problem.rows(i), [&](auto rows) { act(rows, problem.sidesOf(i)); });
}

}  // namespace pincer::engine
