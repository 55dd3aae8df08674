// linear: dense linear equations in the caller's memory. Eigen's decompositions of
// dynamic size allocate; the tick may not.
//
//   A x = b,   A n x n, column-major without gaps
//
// The order of every sum is fixed: the same bits with every compiler. Source: G. Golub, C. Van Loan, Matrix
// Computations, 4th ed. (2013), sections 3.4 (LU with partial pivoting) and 4.1 (LDL^T).
#pragma once

namespace pincer::engine {

// P A = L U in place: U on and above the diagonal, L's multipliers below; row k was swapped with pivots[k]
// >= k. False if a pivot is 0 or not finite.
bool factoriseLu(double* A, int n, int* pivots);

// b becomes the solution of A x = b, from A's factors.
void solveLu(const double* LU, int n, const int* pivots, double* b);

// L D L^T = A in place for symmetric positive definite A, half the work of LU; only A's lower triangle is read and
// written. False if a pivot isn't positive.
bool factoriseLdlt(double* A, int n);

// b becomes the solution of A x = b, from A's factors.
void solveLdlt(const double* LDLT, int n, double* b);

// Both. False, with b undefined, if a pivot isn't positive.
inline bool solveByLdlt(double* A, int n, double* b) {
  if (!factoriseLdlt(A, n)) return false;
  solveLdlt(A, n, b);
  return true;
}

}  // namespace pincer::engine
