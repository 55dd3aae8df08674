// linear: dense linear equations in the caller's memory. Eigen's decompositions of dynamic size allocate; the tick may not.
//
//   A x = b,   A n x n, column-major without gaps
//
// The order of every sum is fixed: the same bits with every compiler. Source: G. Golub, C. Van Loan, Matrix Computations, 4th ed. (2013),
// algorithms 3.4.1 (outer-product LU with partial pivoting) and 4.1.2 (LDL^T).
#pragma once

namespace pincer::engine {

// Solves A x = b in place: A is overwritten by its factors, b by x. False, with b undefined, if a pivot is 0 or not finite.
bool solveByLu(double* A, int n, double* b);

// The same for symmetric positive definite A; reads the lower triangle only. False if a pivot isn't positive. Half the work of solveByLu.
bool solveByLdlt(double* A, int n, double* b);

}  // namespace pincer::engine
