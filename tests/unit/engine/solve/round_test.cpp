// Contacts between balls in their short form do what A does.
#include <gtest/gtest.h>

#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/round_contact.h"
#include "pincer/engine/solve/sweeps.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::ContactScene;
using tests::OwnedContactProblem;
using tests::RandomScenes;

// A ball on the ground and one on it, both moving; the ground is on whichever side.
OwnedContactProblem twoBalls(RandomScenes& random, bool ground_first) {
  ContactScene scene;
  const double radius = random.uniform(0.005, 0.02), small = random.uniform(0.005, 0.02),
               mass = random.uniform(0.01, 1);
  const Vec3 n = random.direction(), m = random.direction();
  const Vec3 p = random.vector(0.1), p_small = p + (radius + small) * m;
  scene.addBody(p, mass, 0.4 * mass * radius * radius, random.vector(1), random.vector(50));
  scene.addBody(p_small, 0.3 * mass, 0.12 * mass * small * small, random.vector(1), random.vector(50));
  if (ground_first)
    scene.addContact(-1, 0, p - radius * n, -n, 0.4);
  else
    scene.addContact(0, -1, p - radius * n, n, 0.4);
  scene.addContact(1, 0, p + radius * m, m, 0.3);
  return scene.build();
}

TEST(RoundContact, MovesWhatItsBlocksMove) {
  RandomScenes random(31);
  for (int n = 0; n < 200; ++n) {
    OwnedContactProblem p = twoBalls(random, n % 2 == 1);
    ContactProblem problem = p.view();
    std::vector<RoundContact> round(p.sides.size());
    findRoundContacts(round, problem);
    for (int i = 0; i < 2; ++i) {
      const RoundContact& c = round[static_cast<std::size_t>(i)];
      const ContactSides& sides = p.sides[static_cast<std::size_t>(i)];
      ASSERT_TRUE(c.isRound()) << n;
      const Eigen::Matrix3d W = p.W.block<3, 3>(3 * i, 3 * i);
      EXPECT_NEAR(1 / c.inverse_W_tt, W(0, 0), 1e-12 * W(0, 0));
      EXPECT_NEAR(1 / c.inverse_W_nn, W(2, 2), 1e-12 * W(2, 2));
      const Eigen::Matrix<double, 12, 1> y =
          Eigen::Matrix<double, 12, 1>::NullaryExpr([&] { return random.uniform(-1, 1); });
      const Vec3 q = random.vector(1), r = random.vector(1);
      Vec3 u, v;
      velocityOf(c, 3, q.data(), y.data(), u.data());
      velocityOf(sides, 3, q.data(), y.data(), v.data());
      EXPECT_LE((u - v).norm(), 1e-13 * (q.norm() + std::sqrt(W.norm()) * y.norm()));  // some roundings
      EXPECT_NEAR(normalVelocityOf(c, q[2], y.data()), v[2], 1e-13 * (q.norm() + std::sqrt(W.norm()) * y.norm()));
      Eigen::Matrix<double, 12, 1> z = y, x = y;
      addImpulse(c, 3, r.data(), z.data());
      addImpulse(sides, 3, r.data(), x.data());
      EXPECT_LE((z - x).norm(), 1e-13 * (y.norm() + std::sqrt(W.norm()) * r.norm()));
    }
  }
}

// A contact beside its centre's normal, or one with torsion, stays as it is.
TEST(RoundContact, IsNoneBesideTheCentreOrWithTorsion) {
  RandomScenes random(33);
  for (int n = 0; n < 100; ++n) {
    ContactScene scene;
    const Vec3 normal = random.direction(), beside = normal.cross(random.direction());
    scene.addBody(Vec3::Zero(), 0.1, 4e-6, random.vector(1), random.vector(1));
    scene.addContact(0, -1, -0.01 * normal + 1e-8 * beside, normal, 0.5);
    scene.addContact(0, -1, -0.01 * normal, normal, 0.5, 0.001);
    for (int k = 0; k < 3; ++k) scene.addContact(0, -1, -0.01 * normal, normal, 0.5);  // so that most are
    OwnedContactProblem p = scene.build();
    ContactProblem problem = p.view();
    std::vector<RoundContact> round(p.sides.size());
    findRoundContacts(round, problem);
    ASSERT_EQ(problem.round.size(), 5u);
    EXPECT_EQ((std::array{round[0].isRound(), round[1].isRound(), round[2].isRound(), round[4].isRound()}),
              (std::array{false, false, true, true}));
  }
}

// The same impulses, whichever form the sweeps read: a heap's sums differ by their round-off.
TEST(RoundContact, IsSweptAsItsBlocksAre) {
  RandomScenes random(35);
  int compared = 0;
  for (int n = 0; n < 100; ++n) {
    OwnedContactProblem p = twoBalls(random, n % 2 == 1);
    Eigen::VectorXd found[2];
    bool converged = true;
    for (int form = 0; form < 2; ++form) {
      SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
      ContactProblem problem = p.view();
      if (form == 1) findRoundContacts(scratch.round, problem);
      Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
      const double enough = 1e-12 * referenceSpeed(problem);
      weighContacts(problem, scratch);
      const ContactError start = errorOf(problem, r.data(), scratch, u.data());
      converged &= Sweeps(problem, scratch, r.data()).until(enough, start, u.data()).error.speed <= enough;
      found[form] = u;
    }
    if (!converged) continue;
    ++compared;
    EXPECT_LE((found[0] - found[1]).norm(), 1e-10 * p.q.norm());  // both to 1e-12, times the condition of W
  }
  EXPECT_GE(compared, 95);
}

}  // namespace
}  // namespace pincer::engine
