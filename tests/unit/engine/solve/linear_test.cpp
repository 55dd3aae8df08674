// Dense solvers in the caller's memory, and the Lorentz cone's algebra, against Eigen and against definitions.
#include "pincer/engine/solve/linear.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "pincer/engine/solve/lorentz.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

constexpr int kRowCounts[] = {3, 4, 6};

Eigen::MatrixXd randomMatrix(tests::RandomScenes& random, int n) {
  Eigen::MatrixXd A(n, n);
  for (int k = 0; k < n * n; ++k) A.data()[k] = random.uniform(-1, 1);
  return A;
}

// Backward stable: |A x - b| is round-off of |A| |x|, whatever A's condition.
// 1e-13 leaves room for pivot growth at n = 40.
RC_GTEST_PROP(Linear, LuSolvesAnyRegularSystem, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int n = random.integer(1, 40);
  const Eigen::MatrixXd A = randomMatrix(random, n);
  const Eigen::VectorXd b = randomMatrix(random, n).col(0);
  Eigen::MatrixXd LU = A;
  Eigen::VectorXd x = b;
  std::vector<int> pivots(static_cast<std::size_t>(n));
  RC_ASSERT(factoriseLu(LU.data(), n, pivots.data()));
  solveLu(LU.data(), n, pivots.data(), x.data());
  RC_ASSERT((A * x - b).norm() <= 1e-13 * (A.norm() * x.norm() + b.norm()));
}

// As in the textbook, which updates all that is left by one column at a time.
Eigen::MatrixXd eliminated(Eigen::MatrixXd A) {
  const int n = static_cast<int>(A.rows());
  for (int k = 0; k < n; ++k) {
    int pivot = 0;
    A.col(k).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    A.row(k).swap(A.row(k + pivot));
    A.col(k).tail(n - k - 1) *= 1 / A(k, k);
    for (int j = k + 1; j < n; ++j) {
      for (int i = k + 1; i < n; ++i) A(i, j) -= A(k, j) * A(i, k);
    }
  }
  return A;
}

// Columns are taken four at a time, numbers in the order of the textbook: sums have the same bits.
RC_GTEST_PROP(Linear, LuHasTheBitsOfElimination, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int n = random.integer(1, 40);
  Eigen::MatrixXd LU = randomMatrix(random, n);
  const Eigen::MatrixXd expected = eliminated(LU);
  std::vector<int> pivots(static_cast<std::size_t>(n));
  RC_ASSERT(factoriseLu(LU.data(), n, pivots.data()));
  RC_ASSERT(LU == expected);
}

RC_GTEST_PROP(Linear, LdltSolvesPositiveDefiniteSystemsFromTheLowerTriangle, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int n = random.integer(1, 40);
  const Eigen::MatrixXd G = randomMatrix(random, n);
  const Eigen::MatrixXd A = G * G.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd b = randomMatrix(random, n).col(0);
  Eigen::MatrixXd lower = A.triangularView<Eigen::Lower>();
  Eigen::VectorXd x = b;
  RC_ASSERT(solveByLdlt(lower.data(), n, x.data()));
  RC_ASSERT((A * x - b).norm() <= 1e-13 * (A.norm() * x.norm() + b.norm()));
}

TEST(Linear, RefusesSingularAndNonFiniteMatrices) {
  int pivots[2];
  double b[] = {1, 1};
  double zero[] = {0, 0, 0, 0};
  double nan[] = {NAN, 0, 0, 1};
  double indefinite[] = {1, 2, 2, 1};
  EXPECT_FALSE(factoriseLu(zero, 2, pivots));
  EXPECT_FALSE(factoriseLu(nan, 2, pivots));
  EXPECT_FALSE(solveByLdlt(indefinite, 2, b));
}

TEST(Linear, LuSwapsRowsWhereAPivotIsZero) {
  double A[] = {0, 2, 3, 4};  // columns (0, 2), (3, 4)
  double b[] = {3, 8};
  int pivots[2];
  ASSERT_TRUE(factoriseLu(A, 2, pivots));
  solveLu(A, 2, pivots, b);
  EXPECT_DOUBLE_EQ(b[0], 2);
  EXPECT_DOUBLE_EQ(b[1], 1);
}

// A point inside the cone.
ContactVector inside(tests::RandomScenes& random, int rows) {
  ContactVector v = ContactVector::Zero();
  for (int k = 0; k < rows; ++k) v[k] = random.uniform(-1, 1);
  v[2] = std::sqrt(tangentNorm2(v.data(), rows)) + random.uniform(0.01, 2);
  return v;
}

RC_GTEST_PROP(Lorentz, DivisionUndoesTheProduct, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int rows = kRowCounts[random.integer(0, 2)];
  const ContactVector a = inside(random, rows), x = inside(random, rows) - inside(random, rows);
  ContactVector ax = ContactVector::Zero(), back = ContactVector::Zero();
  jordanProduct(a.data(), x.data(), rows, ax.data());
  jordanDivide(a.data(), ax.data(), rows, back.data());
  RC_ASSERT((back - x).norm() <= 1e-12 * (1 + x.norm()));  // a is no closer to the boundary than 1e-3 of its size
}

// N maps x and N^-1 maps z onto the same point, and N^-1 undoes N.
RC_GTEST_PROP(Lorentz, NesterovToddScalingBalancesTheTwo, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int rows = kRowCounts[random.integer(0, 2)];
  const ContactVector x = inside(random, rows), z = inside(random, rows);
  const NesterovTodd N(x.data(), z.data(), rows);
  ContactVector Nx = ContactVector::Zero(), Nz = ContactVector::Zero(), back = ContactVector::Zero();
  N.apply(x.data(), rows, Nx.data());
  N.applyInverse(z.data(), rows, Nz.data());
  N.applyInverse(Nx.data(), rows, back.data());
  RC_ASSERT((Nx - Nz).norm() <= 1e-11 * Nx.norm());
  RC_ASSERT((back - x).norm() <= 1e-11 * x.norm());
}

RC_GTEST_PROP(Lorentz, StepEndsOnTheBoundary, (unsigned seed)) {
  tests::RandomScenes random(seed);
  const int rows = kRowCounts[random.integer(0, 2)];
  const ContactVector v = inside(random, rows), dv = inside(random, rows) - inside(random, rows);
  const double t = stepToBoundary(v.data(), dv.data(), rows);
  RC_ASSERT(t > 0);
  const ContactVector before = v + (1 - 1e-9) * t * dv, after = v + (1 + 1e-6) * t * dv;
  RC_ASSERT(isInCone(before.data(), rows, 1));
  RC_ASSERT(t >= 1e3 || !isInCone(after.data(), rows, 1));
}

}  // namespace
}  // namespace pincer::engine
