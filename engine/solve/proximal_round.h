// proximal_round: the contact problem in which contacts give way to what changes their impulses, solved by semi-smooth Newton in the movers' space.
//
//   u = A y + q,   r_i(y) = C_i(r_ci - u_i / e_i),   e_i = epsilon w_i          the answer of  u + e (r - r_c)  for velocities that are u
//   y - A^T r(y) = 0                                                          [sqrt(J)]
//   (I + A^T (D / e) A) dy = -(y - A^T r(y)),   D = dC,                        steps 1, 1/2, .. by |y - A^T r(y)|
//
//   C  Alart and Curnier's projections: r_n = max(0, x_n), r_T = x_T put into the disc of radius mu r_n: Coulomb's law exactly, without a shift
// It always has an answer, wherever there is none without e: what is wrong with r is  give = e (r - r_c), and tends to zero, or to the least by which
// contacts contradict each other, as r_c follows r from round to round (contact_solver.h).
// Sources: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353-375; R. Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898 (proximal
// point); line search: V. Acary, M. Bremond, O. Huber, in Advanced Topics in Nonsmooth Dynamics (2018) 375-457.
#pragma once
#include "pincer/engine/solve/mover_matrix.h"

namespace pincer::engine {

class ProximalRound {
 public:
  ProximalRound(const ContactProblem& problem, MoverMatrix& matrix, SolverScratch& scratch)
      : problem_(problem), matrix_(matrix), scratch_(scratch) {}

  // From scratch.y and u (= A y + q) to the round's answer about scratch.centre: r, with its y and u. Returns the steps that it took, more than
  // `most_steps` if it found none within them; then r is the last one tried. `steps` grows by those taken.
  bool solve(double epsilon, int most_steps, int& steps);

 private:
  double gradient(double epsilon);
  bool step(double epsilon);
  double searchLine(double epsilon, double merit);
  void move(double t);
  int size() const { return kMoverFreedoms * problem_.movers; }

  const ContactProblem& problem_;
  MoverMatrix& matrix_;
  SolverScratch& scratch_;
};

}  // namespace pincer::engine
