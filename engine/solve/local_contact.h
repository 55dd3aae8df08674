// local_contact: the exact solution of the frictional contact problem with a single contact.
//
//   u = W r + q;   take-off: q_n >= 0, r = 0.   Otherwise u_n = 0, which leaves  u_T = A r_T + b,
//   A = W_TT - W_Tn W_nT / W_nn,   b = q_T - W_Tn q_n / W_nn,   r_n = -(q_n + W_nT r_T) / W_nn
//   stick: r_T = -A^-1 b if |r_T| <= mu r_n.   slide: u_T = -alpha r_T, i. e. r_T = -(A + alpha I)^-1 b with |r_T| = mu r_n: one unknown, alpha > 0
//
// r_T -> 0 and r_n -> -q_n / W_nn > 0 as alpha -> infinity, so that the slide case always has a root. It is found on mu r_n / |r_T| = 1, nearly
// linear in alpha (the secular equation of trust-region methods: J. More, D. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553-572),
// by Newton's method inside a bracket.
#pragma once

namespace pincer::engine {

// r = the solution for the `rows` x `rows` block W (column-major with column stride `stride`) and q; rows is 3, 4 or 6.
// Where W makes several solutions possible (large mu W_nT), one of them. r is in the cone to round-off.
void solveOneContact(const double* W, int stride, const double* q, int rows, double mu, double* r);

}  // namespace pincer::engine
