// Problems given as a matrix.
#include <gtest/gtest.h>

#include "pincer/contact/error.h"
#include "pincer/engine/dense_problem.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::OwnedContactProblem;
using tests::RandomScenes;

constexpr SolverOptions kToRoundOff{.tolerance = 1e-12, .accuracy = 0};

DenseAnswer solveAsMatrix(const OwnedContactProblem& p) { return solveDense({p.W, p.q, p.mu}, kToRoundOff); }

// Three boxes on each other, two to six bodies in a cluster, a ring whose contacts are redundant: by the error that
// public sets are judged by, which knows nothing of factors and weights.
TEST(DenseProblem, IsSolvedFromItsMatrixAlone) {
  RandomScenes random(7);
  // contacts that want friction beyond what any finite impulse gives come near it as 1/k: some 2 % of 1000
  int slow = 0;
  for (int n = 0; n < 60; ++n) {
    const OwnedContactProblem p = n % 3 == 0 ? random.stack(3, 1, 1e-2)
                                  : n % 3 == 1
                                      ? random.cluster(random.integer(2, 6), random.integer(4, 12), 10, 1, false)
                                      : random.ring(random.integer(4, 12), 0.01);
    const DenseAnswer answer = solveAsMatrix(p);
    slow += answer.natural_map > 1e-8;
    EXPECT_LE(answer.natural_map, 1e-5) << n;
    EXPECT_LE((p.W * answer.r + p.q - answer.u).cwiseAbs().maxCoeff(), 1e-12 * (1 + p.q.cwiseAbs().maxCoeff())) << n;
  }
  EXPECT_LE(slow, 4);
}

// A box of 1 kg on four corners, every contact as redundant as can be: rank 6 of 12 rows. The four impulses
// carry m g h together, whatever else they do.
TEST(DenseProblem, OfFourCornersCarriesTheWeight) {
  tests::ContactScene scene;
  const int box = scene.addBody(Vec3(0, 0, 0.5), 1, 0.2, Vec3(0, 0, -0.00981), Vec3::Zero());
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) scene.addContact(box, -1, Vec3(x, y, 0), Vec3::UnitZ(), 0.5);
  }
  const DenseAnswer answer = solveAsMatrix(scene.build());
  double weight = 0;
  for (int i = 0; i < 4; ++i) weight += answer.r[3 * i + 2];
  EXPECT_NEAR(weight, 0.00981, 1e-13);
  EXPECT_LE(answer.natural_map, 1e-12);
}

// A W printed with few digits has a small negative eigenvalue, and so no factor: the answer was off by 2.6e-8.
TEST(DenseProblem, ThatIsNearlySemiDefiniteIsRefined) {
  tests::ContactScene scene;
  const int box = scene.addBody(Vec3(0, 0, 0.5), 1, 0.2, Vec3(0.1, 0, -1), Vec3::Zero());
  for (const double x : {-0.5, 0.1, 0.5}) scene.addContact(box, -1, Vec3(x, 0.3 * x, 0), Vec3::UnitZ(), 0.5);
  OwnedContactProblem p = scene.build();
  p.W.diagonal().array() -= 1e-8 * p.W.diagonal().maxCoeff();
  EXPECT_LE(solveAsMatrix(p).natural_map, 1e-8);
}

// Fifty contacts that all see each other: too many for a matrix of contacts, and their factors were written beyond
// their memory.
TEST(DenseProblem, OfFiftyContactsIsSolvedWithinItsMemory) {
  RandomScenes random(8);
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(150, 150, [&](auto, auto) { return random.uniform(-1, 1); });
  const Eigen::VectorXd q = Eigen::VectorXd::NullaryExpr(150, [&](auto) { return random.uniform(-1, 1); });
  const DenseAnswer answer = solveDense({A * A.transpose() / 150, q, std::vector<double>(50, 0.5)}, kToRoundOff);
  EXPECT_LE(answer.natural_map, 1e-8);
}

TEST(DenseProblem, SaysWhatIsWrongWithIt) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(3, 3);
  const Eigen::VectorXd q = -Eigen::VectorXd::Ones(3);
  Eigen::MatrixXd skew = one, negative = one, nan = one;
  skew(0, 1) = 0.1;
  negative(2, 2) = -1;
  nan(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(solveDense({one, q, {0.5, 0.5}}, kToRoundOff), InputError);
  EXPECT_THROW(solveDense({one, q, {-0.5}}, kToRoundOff), InputError);
  EXPECT_THROW(solveDense({skew, q, {0.5}}, kToRoundOff), InputError);
  EXPECT_THROW(solveDense({negative, q, {0.5}}, kToRoundOff), InputError);
  EXPECT_THROW(solveDense({nan, q, {0.5}}, kToRoundOff), InputError);
  EXPECT_EQ(solveDense({Eigen::MatrixXd(0, 0), Eigen::VectorXd(0), {}}, kToRoundOff).r.size(), 0);
}

}  // namespace
}  // namespace pincer::engine
