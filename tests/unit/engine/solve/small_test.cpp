// One to three contacts: Newton's method in fixed sizes against the general one.
#include <gtest/gtest.h>

#include "pincer/engine/solve/small_problem.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

struct SmallTrial {
  int solved = 0, all = 0;
  double furthest = 0;  // from the general method's velocities, relative
};

// Grasps by up to three fingers, from the impulses of a similar one. The general method: four times the problem, side
// by side, is too large for the fixed sizes, and has the same answer.
SmallTrial tryGrasps(int fingers, bool torsion) {
  tests::RandomScenes random(11);
  SmallTrial trial;
  for (int scene = 0; scene < 200; ++scene) {
    tests::OwnedContactProblem p = random.grasp(fingers, 1, torsion);
    const int n = static_cast<int>(p.mu.size()), m = static_cast<int>(p.q.size());
    tests::OwnedContactProblem four = p;
    for (int copy = 1; copy < 4; ++copy) {
      for (int i = 0; i < n; ++i) {
        four.sides.push_back(p.sides[i]);
        for (ContactSide& side : four.sides.back()) side.mover += side.mover >= 0 ? copy * p.movers : 0;
        four.mu.push_back(p.mu[i]);
        four.first_row.push_back(copy * m + p.first_row[i + 1]);
      }
    }
    four.movers = 4 * p.movers;
    four.q = p.q.replicate(4, 1);
    SolverScratch scratch(4 * n, four.movers);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(m), u = r, r4 = Eigen::VectorXd::Zero(4 * m), u4 = r4;
    solveContacts(four.view(), {.accuracy = 0}, scratch, {r4.data(), 4 * m}, {u4.data(), 4 * m});
    r = 1.01 * r4.head(m);
    SolveResult result;
    ++trial.all;
    if (!solveSmallProblem(p.view(), {}, r.data(), u.data(), result)) continue;
    ++trial.solved;
    EXPECT_LE(result.residual, 1e-10);
    EXPECT_LE(contactResidual(p.view(), r, scratch, u), 2e-10);  // the same, by the factors of W
    trial.furthest = std::max(trial.furthest, (u - u4.head(m)).norm() / p.q.norm());
  }
  return trial;
}

TEST(SmallProblem, AgreesWithTheGeneralMethod) {
  for (const int fingers : {1, 2, 3}) {
    for (const bool torsion : {false, true}) {
      const SmallTrial trial = tryGrasps(fingers, torsion);
      EXPECT_GT(trial.solved, 0.9 * trial.all) << fingers << (torsion ? " with torsion" : "");
      EXPECT_LT(trial.furthest, 1e-8);  // both within 1e-10 of the law; grasps are conditioned to 100
    }
  }
}

TEST(SmallProblem, LeavesWhatItDoesNotSolveAsItWas) {
  tests::RandomScenes random(3);
  tests::OwnedContactProblem p = random.grasp(2, 1, false);
  p.q[0] = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd r = Eigen::VectorXd::Constant(p.q.size(), 0.5), u = r;
  SolveResult result;
  EXPECT_FALSE(solveSmallProblem(p.view(), {}, r.data(), u.data(), result));
  EXPECT_EQ(r, Eigen::VectorXd::Constant(p.q.size(), 0.5));
}

}  // namespace
}  // namespace pincer::engine
