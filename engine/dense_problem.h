// dense_problem: a contact problem given as a matrix, as public problem sets and other engines have
// them, solved by the engine's own method.
//
//   u = W r + q,   r in K_mu,   K*_mu contains u + mu |u_T| e_n,   perpendicular to r      per contact, rows t1, t2, n
//
// The engine wants W = A A^T with A in blocks of movers (solve/contact_problem.h): any factor will do, so one is
// found by Cholesky's method with pivots, which also finds W's rank. Not for the tick: it allocates, and its time
// grows with the cube of the rank. Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed.
// (2002), section 10.3 (semi-definite matrices).
#pragma once
#include <Eigen/Core>
#include <vector>

#include "pincer/engine/solver.h"

namespace pincer::engine {

struct DenseProblem {
  Eigen::MatrixXd W;       // 3 n x 3 n, symmetric positive semi-definite [1/kg]
  Eigen::VectorXd q;       // 3 n [m/s]
  std::vector<double> mu;  // n, each >= 0 [-]
};

struct DenseAnswer {
  Eigen::VectorXd r, u;  // 3 n each [N s], [m/s]
  SolveResult result;    // as the engine sees it
  // |r - P_K(r - (u + mu |u_T| e_n))| / |q| with u = W r + q, of W as given: what public sets are judged by.
  double natural_map = 0;
};

// Throws InputError: shapes that don't agree, what isn't finite, a negative friction, a W that isn't symmetric or not
// semi-definite (to 1e-9 of its largest entry).
DenseAnswer solveDense(const DenseProblem& problem, const SolverOptions& options);

}  // namespace pincer::engine
