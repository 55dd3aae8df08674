// local_contact: the exact solution of the frictional contact problem with a single contact.
//
//   u = W r + q;   take-off: q_n >= 0, r = 0.   Otherwise u_n = 0, which leaves  u_T = A r_T + b,
//   A = W_TT - W_Tn W_nT / W_nn,   b = q_T - W_Tn q_n / W_nn,   r_n = -(q_n + W_nT r_T) / W_nn
//   stick: r_T = -A^-1 b if |r_T| <= mu r_n.   slide: u_T = -alpha r_T, i. e. r_T = -(A + alpha I)^-1 b
//                                              with |r_T| = mu r_n: one unknown, alpha > 0
//
// r_T -> 0 and r_n -> -q_n / W_nn > 0 as alpha -> infinity, so that the slide case always has a root. It is found on mu
// r_n / |r_T| = 1, nearly linear in alpha (the secular equation of trust-region methods: J. More, D. Sorensen, SIAM J.
// Sci. Stat. Comput. 4 (1983) 553-572), by Newton's method inside a bracket.
//
// Where W is isotropic, as where spheres touch, A is a multiple of the identity: what
// slides has the direction of what would stick (limitFriction, cone.h).
#pragma once
#include "pincer/engine/solve/contact_problem.h"

namespace pincer::engine {

constexpr double kBlockRoundOff = 1e-12;  // of A and W: their round-off, far below any tolerance

// True if, of three rows, all directions along the surface are alike and the normal is apart from them.
bool isIsotropic(const double* W, int stride);

// r = the solution for the `rows` x `rows` block W (column-major with column stride `stride`) and q; rows is 3, 4 or 6.
// Where W makes several solutions possible (large mu W_nT), one of them. r is in the cone to round-off.
// Returns how many steps the search for alpha took.
//   alpha  where problems that hardly differ follow each other, as those of a contact from sweep to sweep: that of the
//          one before, one step from here [kg^-1]; 0: of none, or it didn't slide. Becomes this one's.
int solveOneContact(const double* W, int stride, const double* q, int rows, double mu, double* r, double& alpha);
inline int solveOneContact(const double* W, int stride, const double* q, int rows, double mu, double* r) {
  double alpha = 0;
  return solveOneContact(W, stride, q, rows, mu, r, alpha);
}

}  // namespace pincer::engine
