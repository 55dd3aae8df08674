// alternation: the contact problem by the alternating direction method of multipliers, with de Saxce's shift of the step before.
//
//   r <- (W + rho w)^-1 (rho w z - q - s - l),   z <- P_K(r + l / (rho w)),   l <- l + rho w (r - z),   s_i = mu_i |l_iT| e_n
//
//   z  impulses, in the cones [N s];   l  multipliers, -l the velocities [m/s];   w  weights of the contacts [1/kg];   rho [-]
// One factorisation per rho serves all steps, in the movers' space: (W + rho w)^-1 b = (b - A H^-1 A^T b / (rho w)) / (rho w), H = I + A^T (rho w)^-1 A.
// It never diverges and needs no line search: it comes near from wherever it starts, and slows down there.
// Sources: J. Carpentier, Q. Le Lidec, L. Montaut, Robotics: Science and Systems (2024); S. Boyd et al., Found. Trends Mach. Learn. 3 (2011) 1-122, section
// 3.4 (rho from the residuals).
#pragma once
#include "pincer/engine/solve/mover_matrix.h"

namespace pincer::engine {

class Alternation {
 public:
  Alternation(const ContactProblem& problem, MoverMatrix& matrix, SolverScratch& scratch)
      : problem_(problem), matrix_(matrix), scratch_(scratch) {}

  // `steps` from scratch.centre, whose velocities scratch.u are; scratch.centre is the last z. False if the budget is spent or the matrix singular.
  //   resume  with the multipliers of the last call, not -u
  bool run(int steps, bool resume);

 private:
  bool factorise();
  void takeStep();
  void adapt();

  const ContactProblem& problem_;
  MoverMatrix& matrix_;
  SolverScratch& scratch_;
  double rho_ = 0.03, factored_ = 0;
  double primal_ = 0, dual_ = 0;  // of the last step: w |r - z| and rho w |change of z|, the largest [m/s]
};

}  // namespace pincer::engine
