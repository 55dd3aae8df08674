// contact_problem: the one-step frictional contact problem on which engine/solve works.
//
//   u = W r + q,     K*_mu contains u + mu |u_T| e_n,  perpendicular to  r in K_mu      (per contact)
//   W = A A^T,       A_ib = J_ib M_b^-1/2      (contact i, mover b)
//
//   W  Delassus operator J M^-1 J^T [1/kg], symmetric positive semi-definite. It is never
//      stored whole: A has two blocks per contact
//   A  how contact i's velocity follows mover b's scaled velocity M_b^1/2 v_b [kg^-1/2];
//      M^-1/2 any factor with M^-1/2 M^-T/2 = M^-1
//   q  contact velocity that the step would end with if no contact acted, plus biases [m/s]
//   r  contact impulses [N s];  u  contact velocities [m/s]
// A contact has 3 rows (t1, t2, n), 4 (and torsion, about n), or 6 (and rolling, about t1 and t2). Torsion is
// scaled by its equivalent radius e_t, rolling by e_r, so that they, too, are in m/s and N s. K_mu = { |(r_t1,
// r_t2[, r_tau[, r_rho1, r_rho2]])| <= mu r_n }. The shift mu |u_T| e_n is de Saxce's: with it sliding is
// tangential (no dilation). A mover that doesn't move has no block. Compliance is inertia: a mover of its own.
// Source: G. De Saxce, Z.-Q. Feng, Math. Comput. Modelling 28 (1998) 225-245; notation of V. Acary, F. Cadoux, C.
// Lemarechal, J. Malick, ZAMM 91 (2011) 155-175, eq. (10).
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <type_traits>

#include "pincer/contact/math.h"
#include "pincer/engine/solver.h"

namespace pincer::engine {

using VectorMap = Eigen::Map<Eigen::VectorXd>;

constexpr int kMoverFreedoms = 6;  // of a rigid body; runs of joints are cut to it

// Calls act with the number of rows, as a constant where it is three or, with torsion, four: nearly all contacts have
// so many, and the compiler knows what to do then.
template <class Act>
[[gnu::always_inline]] inline void withRows(int rows, const Act& act) {
  if (rows == kTorsionRow) {
    act(std::integral_constant<int, kTorsionRow>());
  } else if (rows == kRollingRow) {
    act(std::integral_constant<int, kRollingRow>());
  } else {
    act(rows);
  }
}

// A's block of one contact and one of the two that touch; rows beyond the contact's are never read.
// Of three rows the first three lines of the cache are all that is read: heaps are larger than the cache.
struct alignas(64) ContactSide {
  int mover = -1;         // 0 .. movers - 1; -1: nothing there moves, A isn't read
  bool is_point = false;  // of three rows, and the mover doesn't turn: the last three columns are 0
  alignas(16) double A[kMaxContactRows][kMoverFreedoms];
};
using ContactSides = std::array<ContactSide, 2>;  // of what has one mover on each side; never both the same

// The same of a contact between balls, see round_contact.h.
struct alignas(64) RoundContact {
  double R[kTorsionRow][3];
  double linear[2], turn[2];
  double inverse_W_tt, inverse_W_nn;  // [kg]
  int mover[2];                       // of what doesn't move the other one, and 0 for its share

  bool isRound() const { return inverse_W_tt > 0; }
};

// Contact's among `sides`: two each, or those from first_side[contact] on.
inline std::span<const ContactSide> sidesAt(std::span<const ContactSide> sides, std::span<const int> first_side,
                                            int contact) {
  const auto i = static_cast<std::size_t>(contact);
  if (first_side.empty()) return sides.subspan(2 * i, 2);
  return sides.subspan(static_cast<std::size_t>(first_side[i]),
                       static_cast<std::size_t>(first_side[i + 1] - first_side[i]));
}

constexpr double kGapNoise = 1e-14;  // of gaps: a tick of 1 ms undoes a fifth of 5e-17 m [m/s]

// Views onto memory that somebody else owns (engine/world's scratch). n contacts, m rows in all.
struct ContactProblem {
  std::span<const int> first_row;      // size n + 1; contact i owns rows first_row[i] .. first_row[i + 1] - 1
  std::span<const double> mu;          // size n, each >= 0 [-]
  std::span<const ContactSide> sides;  // contact by contact: two each, or those of first_side
  VectorMap q;                         // m
  int movers = 0;
  bool strict = false;  // the warm start is only taken where it is exact to round-off, see contact_solver.h
  bool calm = false;    // nothing of it moves faster than rest (restErrorOf)
  std::span<const RoundContact> round = {};  // of each contact; empty where nobody looked
  std::span<const int> first_side = {};      // size n + 1; empty where every contact has two sides
  double noise = kGapNoise;                  // what round-off asks for in every tick [m/s]
  std::span<const double> weight = {};       // size n: weightOf each (residual.h); empty where nobody weighed them

  int contactCount() const { return static_cast<int>(mu.size()); }
  int rowCount() const { return static_cast<int>(q.size()); }
  int firstRow(int contact) const { return first_row[static_cast<std::size_t>(contact)]; }
  int rows(int contact) const { return firstRow(contact + 1) - firstRow(contact); }
  double friction(int contact) const { return mu[static_cast<std::size_t>(contact)]; }
  // Of any number of movers, no two of them the same; those with mover -1 don't count.
  std::span<const ContactSide> sidesOf(int contact) const { return sidesAt(sides, first_side, contact); }
};

}  // namespace pincer::engine
