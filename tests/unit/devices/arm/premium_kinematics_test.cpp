#include "pincer/devices/arm/premium_kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "pincer/tests/support/random_numbers.h"

namespace pincer::devices::premium {
namespace {

Vec3 anyAngles(tests::RandomNumbers& draw) {
  const JointLimits limits;
  for (;;) {
    const Vec3 q(draw.uniform(limits.min[0], limits.max[0]), draw.uniform(limits.min[1], limits.max[1]),
                 draw.uniform(limits.min[2], limits.max[2]));
    if (withinLimits(limits, q)) return q;
  }
}

TEST(PremiumKinematics, PutsTheResetPlaceAtTheOrigin) { EXPECT_EQ(forward(Vec3::Zero()).norm(), 0); }

// Three postures that can be read off a drawing.
TEST(PremiumKinematics, FollowsTheLinksInPosturesThatAreEasyToDraw) {
  const double quarter = std::numbers::pi / 2;
  const double rounding = 1e-16;                                              // cos(pi/2) isn't 0
  EXPECT_LE((forward({quarter, 0, 0}) - Vec3(l1, 0, -l1)).norm(), rounding);  // turned to the right
  EXPECT_LE((forward({0, quarter, 0}) - Vec3(0, l1, -l1)).norm(), rounding);  // upper link upright
  EXPECT_LE((forward({0, 0, quarter}) - Vec3(0, l2, l2)).norm(), rounding);   // stretched forward
}

TEST(PremiumKinematics, KeepsTheLengthsOfItsLinks) {
  tests::RandomNumbers draw(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = anyAngles(draw);
    const Vec3 shoulder(0, l2, -l1);
    const Vec3 upper = l1 * Vec3(std::sin(q[0]) * std::cos(q[1]), std::sin(q[1]), std::cos(q[0]) * std::cos(q[1]));
    EXPECT_NEAR((forward(q) - shoulder - upper).norm(), l2, 1e-15);  // a few ulp of 0.2 m
  }
}

TEST(PremiumKinematics, InverseUndoesForward) {
  tests::RandomNumbers draw(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = anyAngles(draw);
    const auto back = inverse(forward(q));
    ASSERT_TRUE(back);
    EXPECT_LE((*back - q).norm(), 1e-14);  // acos loses 1 / sin(elbow angle), < 4 within the stops
  }
}

TEST(PremiumKinematics, HasNoAnswerBeyondItsReach) {
  const Vec3 shoulder(0, l2, -l1);
  EXPECT_FALSE(inverse(shoulder + Vec3(0, 0, l1 + l2 + 1e-6)));
  EXPECT_TRUE(inverse(shoulder + Vec3(0, 0, l1 + l2 - 1e-6)));
  EXPECT_FALSE(inverse(shoulder + Vec3(0, 0, l1 - l2 - 1e-6)));  // too near to fold up to
  EXPECT_FALSE(inverse(shoulder));
  EXPECT_FALSE(inverse(Vec3(std::nan(""), 0, 0)));
}

TEST(PremiumKinematics, JacobianIsTheDerivativeOfForward) {
  tests::RandomNumbers draw(3);
  const double e = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = anyAngles(draw);
    Mat3 J;
    for (int k = 0; k < 3; ++k) J.col(k) = (forward(q + e * Vec3::Unit(k)) - forward(q - e * Vec3::Unit(k))) / (2 * e);
    EXPECT_LE((jacobian(q) - J).cwiseAbs().maxCoeff(), 5e-10);  // rounding 1e-16 / e, truncation e^2 / 6
  }
}

TEST(PremiumKinematics, DexterityIsTheDeterminantOverItsValueAtReset) {
  tests::RandomNumbers draw(4);
  const double at_reset = jacobian(Vec3::Zero()).determinant();
  EXPECT_NEAR(at_reset, l1 * l1 * l2, 1e-17);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 q = anyAngles(draw);
    EXPECT_NEAR(dexterity(q), jacobian(q).determinant() / at_reset, 1e-14);
    EXPECT_GT(dexterity(q), 0) << "a singular posture within the stops";
  }
  EXPECT_NEAR(dexterity({0.3, 0, std::numbers::pi / 2}), 0, 1e-15);  // stretched
}

TEST(PremiumKinematics, WorkspaceBoxLiesWithinTheStops) {
  for (int i = 0; i <= 1000; ++i) {
    const Vec3 share(i / 100 / 10.0, i / 10 % 10 / 9.0, i % 10 / 9.0);
    const Vec3 p = kWorkspaceMin_D + share.cwiseProduct(kWorkspaceMax_D - kWorkspaceMin_D);
    const auto q = inverse(p);
    ASSERT_TRUE(q);
    EXPECT_TRUE(withinLimits({}, *q));
    EXPECT_GT(dexterity(*q), 0.5);
  }
}

}  // namespace
}  // namespace pincer::devices::premium
