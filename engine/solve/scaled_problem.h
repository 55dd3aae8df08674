// scaled_problem: a ContactProblem in variables in which every contact weighs the same.
//
//   r^ = s r,   u^ = u / s,   A^_i = A_i / s_i,   W^ = A^ A^^T,   q^ = q / s
//   s_i = sqrt(w_i),   w_i  mean of W_ii's diagonal
//
// s is one number per contact, so the cones and the law are unchanged; r^ and u^ are both in
// sqrt(J). The diagonal of W^ is about 1, whatever the masses, so Alart-Curnier's rho, the line
// search's merit and the regularisation need no tuning.
#pragma once
#include "pincer/engine/solve/contact_problem.h"
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

struct ScaledProblem {
  std::span<const int> first_row;
  std::span<const double> mu;
  std::span<const ContactSide> sides;  // A^ [-], as the problem's; with W^, only once scaleSides has been called
  // W^, m x m [-]; null where the problem is better treated mover by mover (contact_equations.h)
  const double* W = nullptr;
  const double* q = nullptr;      // [sqrt(J)]
  const double* scale = nullptr;  // s, one per contact [1/sqrt(kg)]
  double* y = nullptr;            // working memory, kMoverFreedoms per mover
  double speed = 1;               // what residuals are relative to [m/s], see contactResidual
  int movers = 0;
  std::span<const int> first_side = {};  // the problem's

  int contactCount() const { return static_cast<int>(mu.size()); }
  int rowCount() const { return first_row.back(); }
  int firstRow(int contact) const { return first_row[static_cast<std::size_t>(contact)]; }
  int rows(int contact) const { return firstRow(contact + 1) - firstRow(contact); }
  double friction(int contact) const { return mu[static_cast<std::size_t>(contact)]; }
  std::span<const ContactSide> sidesOf(int contact) const { return sidesAt(sides, first_side, contact); }
};

// Scales `problem`, its contacts weighed (residual.h), into `scratch`; W^ as well if `dense`. Where some w_i isn't
// positive and finite, no iterate has a finite residual.
ScaledProblem scaleProblem(const ContactProblem& problem, bool dense, SolverScratch& scratch);

// Fills the scaled problem's sides, where that is done without W^ as well.
void scaleSides(const ContactProblem& problem, SolverScratch& scratch);

// An attempt at a solution, in scaled variables; the arrays belong to SolverScratch.
struct Iterate {
  double* r;            // impulses, in the cones
  double* u;            // velocities W^ r + q^
  double residual = 0;  // contactResidual of r
};

// out = W^ r
void multiply(const ScaledProblem& problem, const double* r, double* out);

// Multiplications of an evaluation and of what is decided by it.
std::int64_t costOfLook(const ScaledProblem& problem);

// Fills `it.u` and `it.residual` from `it.r`; the second where u is known.
void evaluate(const ScaledProblem& problem, Iterate& it);
void judge(const ScaledProblem& problem, Iterate& it);

}  // namespace pincer::engine
