// Contacts that contradict each other, and give way.
#include <gtest/gtest.h>

#include "pincer/engine/solve/contact_solver.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::ContactScene;
using tests::OwnedContactProblem;

SolverOptions giving(double most) {
  SolverOptions options;
  options.largest_give = most;
  return options;
}

// A body between two walls that both close by `closing` [m/s]: it can't follow both.
OwnedContactProblem squeezed(double closing) {
  ContactScene scene;
  scene.addBody(Vec3::Zero(), 0.1, 1e-5, Vec3(0, 0, -0.01), Vec3::Zero());
  for (const double side : {1.0, -1.0})
    scene.addContact(0, -1, Vec3(-0.01 * side, 0, 0), Vec3(side, 0, 0), 0.5, 0, -closing);
  return scene.build();
}

// By symmetry both give way by as much as they close, and the body hangs between them.
TEST(Giving, WallsThatCloseFromBothSidesGiveWayByAsMuch) {
  constexpr double kClosing = 1e-5;
  OwnedContactProblem p = squeezed(kClosing);
  const ContactProblem view = p.view();
  SolverScratch scratch(2, 1);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(6), u(6);
  const SolveResult result = solveContacts(view, giving(1e-4), scratch, {r.data(), 6}, {u.data(), 6});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.give, kClosing, 1e-9);  // the tolerance, 1e-10 of 0.01 m/s, over the epsilon of a round
  const Eigen::Map<Eigen::VectorXd> give(scratch.give.data(), 6);
  EXPECT_NEAR(give[2], kClosing, 1e-9);
  EXPECT_NEAR(give[5], kClosing, 1e-9);
  const Eigen::VectorXd u_given = p.W * r + p.q + give;
  EXPECT_LE((u - u_given).norm(), 1e-12);
  OwnedContactProblem given = p;
  given.q += give;
  SolverScratch judge(2, 1);
  EXPECT_LE(contactResidual(given.view(), r, judge, u), 1e-10);
}

TEST(Giving, IsAskedForAndNoMoreThanThat) {
  for (const double most : {0.0, 1e-4}) {
    OwnedContactProblem p = squeezed(1e-3);
    const tests::Solved s = solve(p, giving(most));
    EXPECT_FALSE(s.result.converged);
    EXPECT_EQ(s.result.give, 0);
  }
}

// Both soft, the body still by symmetry:  -v + epsilon w r_n = 0,  w = (1/m + 2 (1/m + a^2/I)) / 3.
TEST(Squeeze, OfWallsThatCloseIsThatOfSoftContacts) {
  for (const double closing : {1e-4, 1e-3, 0.1, 10.0}) {
    OwnedContactProblem p = squeezed(closing);
    const tests::Solved s = solve(p);
    EXPECT_FALSE(s.result.converged);
    EXPECT_TRUE(s.result.yields);
    const double w = (10 + 2 * (10 + 1e-4 / 1e-5)) / 3;
    for (const int row : {2, 5}) EXPECT_NEAR(s.r[row], closing / (1e-3 * w), 1e-6 * closing / (1e-3 * w));
    EXPECT_NEAR(s.u[2], -closing, 1e-9 * closing);
  }
}

// Bounded answers, however large, aren't taken for it: a stack whose top is a million times as heavy as its base.
TEST(Squeeze, IsNotSeenWhereALightBodyCarriesAHeavyOne) {
  for (const double ratio : {1.0, 1e3, 1e6}) {
    tests::RandomScenes random(17);
    OwnedContactProblem p = random.stack(3, ratio, 0);
    const tests::Solved s = solve(p);
    EXPECT_TRUE(s.result.converged) << ratio;
    EXPECT_FALSE(s.result.yields) << ratio;
  }
}

// A problem that has an answer needn't give way.
TEST(Giving, IsLeftAloneWhereThereIsAnAnswer) {
  tests::RandomScenes random(5);
  int compared = 0;
  for (int n = 0; n < 200; ++n) {
    OwnedContactProblem p = random.cluster(6, 14, 10, 0.8, false), q = p;
    const tests::Solved plain = solve(p), s = solve(q, giving(1e-4));
    if (plain.result.method != SolveMethod::kNewton) continue;
    ++compared;
    EXPECT_EQ(s.result.give, 0) << n;
    EXPECT_EQ(s.r, plain.r) << n;
  }
  EXPECT_GE(compared, 180);  // 194 today
}

}  // namespace
}  // namespace pincer::engine
