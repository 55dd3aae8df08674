// proximal_round: the contact problem in which contacts give way to what changes their impulses, solved by
// semi-smooth Newton in the movers' space.
//
//   u = A y + q,   r_i(y) = C_i(r_ci - u_i / e_i),   e_i = epsilon w_i
//     the answer of  u + e (r - r_c)  for velocities that are u
//   y - A^T r(y) = 0                                                          [sqrt(J)]
//   (I + A^T (D / e) A) dy = -(y - A^T r(y)),   D = dC,                        steps 1, 1/2, .. by |y - A^T r(y)|
//
//   C  Alart and Curnier's projections: r_n = max(0, x_n), r_T = x_T put into the disc of radius mu
//      r_n: Coulomb's law exactly, without a shift
// It always has an answer, wherever there is none without e: what is wrong with r is  give = e (r - r_c), and tends to
// zero, or to the least by which contacts contradict each other, as r_c follows r from round to round
// (contact_solver.h). Far from it the steps may not find it.
//
// With the shift frozen, s_i = mu_i |u_iT| of the round's start, the round is the least of a convex energy, and
// Newton's method finds it from wherever it starts, by steps to where the energy is least along them:
//
//   minimise over y   |y|^2 / 2 + sum_i e_i |P_K(r_ci - (u_i + s_i e_n) / e_i)|^2 / 2
//   r_i(y) = P_K(r_ci - (u_i + s_i e_n) / e_i)
//
// The error of r is then the give, and by how much the shift has changed.
// Sources: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353-375; R. Rockafellar, SIAM J. Control
// Optim. 14 (1976) 877-898 (proximal point); line search: V. Acary, M. Bremond, O. Huber, in Advanced Topics in
// Nonsmooth Dynamics (2018) 375-457; frozen shift: V. Acary, F. Cadoux, C. Lemarechal, J. Malick, ZAMM 91 (2011)
// 155-175; its energy: A. Castro, F. Permenter, X. Han, IEEE Trans. Robot. 39 (2023) 1301-1320.
#pragma once
#include "pincer/engine/solve/mover_matrix.h"

namespace pincer::engine {

constexpr int kTrials = 6;                    // step lengths 1, 1/2, .. 1/32
constexpr double kSufficientDecrease = 1e-4;  // of the merit, Armijo's
constexpr int kMostRoundSteps = 8;            // of a round with Coulomb's law as it is

enum class Shift : unsigned char { kFollows, kFrozen };

class ProximalRound {
 public:
  ProximalRound(const ContactProblem& problem, MoverMatrix& matrix, SolverScratch& scratch)
      : problem_(problem), matrix_(matrix), scratch_(scratch) {}

  struct Limits {
    double epsilon;  // e_i = epsilon w_i [-]
    double left;     // of A (y - A^T r) when it is solved, at most [m/s]
    int steps;
  };

  // From scratch.y and u (= A y + q) to the round's answer about scratch.centre: r, with its y and u. False if it
  // wasn't found; then r is the last one tried. `steps` grows by those taken.
  bool solve(Shift shift, const Limits& limits, int& steps);

 private:
  void freeze();
  double gradient();
  bool isLeftBelow(double speed);
  bool step();
  void addToMatrix(int i, int rows, const double* x);
  void addFrozenToMatrix(int i, int rows, const double* x);
  void move(double t);
  double searchLine(double merit);
  double minimise();
  double slope() const;
  double inverseE(int i) const { return 1 / (epsilon_ * scratch_.weight[static_cast<std::size_t>(i)]); }
  double frozenShift(int i) const {
    return shift_ == Shift::kFrozen ? scratch_.frozen[static_cast<std::size_t>(i)] : 0;
  }
  int size() const { return kMoverFreedoms * problem_.movers; }

  const ContactProblem& problem_;
  MoverMatrix& matrix_;
  SolverScratch& scratch_;
  Shift shift_ = Shift::kFollows;
  double epsilon_ = 0;
};

}  // namespace pincer::engine
