// Free rotation against closed forms, conservation laws and an independent integrator.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "pincer/engine/motion/free_motion.h"

namespace pincer::engine {
namespace {

constexpr double kRotationStep = 1e-3;  // [s]

Vec3 boxMoments(double mass, const Vec3& edges) {
  const Vec3 sq = edges.cwiseAbs2();
  return mass / 12 * Vec3(sq.y() + sq.z(), sq.x() + sq.z(), sq.x() + sq.y());
}
const Vec3 kBox = boxMoments(0.1, {0.02, 0.04, 0.08});  // of 20 x 40 x 80 mm

double angleBetween(const Quat& a, const Quat& b) { return 2 * (a.conjugate() * b).vec().norm(); }

double energy(const FreeRotation& rotation, const Quat& q, const Vec3& L) {
  return 0.5 * L.dot(angularVelocity(rotation, q, L));
}

Quat advance(const Vec3& moments, const Vec3& L, double h, int steps) {
  const FreeRotation rotation(moments);
  Quat q = Quat::Identity();
  for (int n = 0; n < steps; ++n) rotateFreely(rotation, L, h, q);
  return q;
}

// Runge-Kutta of order 4 on Euler's equations, w in the body's frame: shares nothing with the method under test.
Quat rungeKutta(const Vec3& moments, const Vec3& w_start, double h, int steps) {
  using State = Eigen::Matrix<double, 7, 1>;  // q (x, y, z, w), angular velocity
  const auto rate = [&](const State& s) {
    const Vec3 w = s.tail<3>();
    const Quat q(s[3], s[0], s[1], s[2]);
    State d;
    d.head<4>() = 0.5 * (q * Quat(0, w.x(), w.y(), w.z())).coeffs();
    d.tail<3>() = (moments.cwiseProduct(w).cross(w)).cwiseQuotient(moments);
    return d;
  };
  State s;
  s << 0, 0, 0, 1, w_start;
  for (int n = 0; n < steps; ++n) {
    const State a = rate(s), b = rate(s + 0.5 * h * a), c = rate(s + 0.5 * h * b), d = rate(s + h * c);
    s += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return Quat(s[3], s[0], s[1], s[2]).normalized();
}

TEST(FreeRotation, SortsBodiesByTheirSymmetry) {
  EXPECT_EQ(FreeRotation(Vec3(2, 2, 2)).kind, FreeRotation::Kind::kSpherical);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 moments(2, 2, 2);
    moments[axis] = 3;
    const FreeRotation top(moments);
    EXPECT_EQ(top.kind, FreeRotation::Kind::kSymmetric);
    EXPECT_EQ(top.k, axis);
    EXPECT_EQ(top.i, (axis + 1) % 3);
    EXPECT_EQ(top.j, (axis + 2) % 3);
  }
  EXPECT_EQ(FreeRotation(kBox).kind, FreeRotation::Kind::kTriaxial);
  EXPECT_EQ(FreeRotation(kBox).k, 2);  // 1/I is (15, 18, 60) 1e3: without the third, the closest two
}

TEST(FreeRotation, TurnsABallAboutItsMomentum) {
  const double I = 1.6e-5;
  const Vec3 w(30, -20, 50);
  const Quat q = advance(Vec3::Constant(I), I * w, kRotationStep, 1000);
  EXPECT_LE(angleBetween(q, Quat(Eigen::AngleAxisd(w.norm(), w.normalized()))), 1e-12);  // 1000 round-offs of 1e-15
}

// A symmetric top in closed form: precession about L by |L| t / I_1 after spin about the axis by
// L_3 t (1/I_3 - 1/I_1); at any step size.
TEST(FreeRotation, IsExactForSymmetricTops) {
  for (const Vec3& moments : {Vec3(4e-5, 4e-5, 1e-5), Vec3(3e-5, 5e-5, 5e-5), Vec3(2e-5, 3.9e-5, 2e-5)}) {
    const FreeRotation top(moments);
    const Vec3 w(10, -30, 50), L = moments.cwiseProduct(w);
    const double I_1 = moments[top.i], I_3 = moments[top.k];
    const Quat exact = Quat(Eigen::AngleAxisd(L.norm() / I_1, L.normalized())) *
                       Quat(Eigen::AngleAxisd(L[top.k] * (1 / I_3 - 1 / I_1), Vec3::Unit(top.k)));
    EXPECT_LE(angleBetween(advance(moments, L, 1, 1), exact), 1e-13);
    EXPECT_LE(angleBetween(advance(moments, L, 1e-3, 1000), exact), 1e-12);
    EXPECT_LE(angleBetween(advance(moments, L, 1e-4, 10000), exact), 1e-11);
  }
}

// Box spinning about its middle axis, almost: the reference is itself accurate to
// 1e-9 (halving its step changes it by less).
TEST(FreeRotation, FollowsATumblingBox) {
  const Vec3 w(0.02, 20, 0.02), L = kBox.cwiseProduct(w);
  const Quat reference = rungeKutta(kBox, w, 2e-5, 50000);
  EXPECT_LE(angleBetween(reference, rungeKutta(kBox, w, 4e-5, 25000)), 1e-9);
  EXPECT_LE(angleBetween(advance(kBox, L, kRotationStep, 1000), reference), 1e-9);
}

TEST(FreeRotation, ConvergesWithOrderFour) {
  const Vec3 L = kBox.cwiseProduct(Vec3(60, 50, 70));
  const Quat reference = advance(kBox, L, 1e-4, 2000);
  const double coarse = angleBetween(advance(kBox, L, 4e-3, 50), reference);
  const double fine = angleBetween(advance(kBox, L, 2e-3, 100), reference);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3);
  EXPECT_LE(fine, 1e-3);
}

// Dzhanibekov: from the middle axis the box turns over, from the others it doesn't.
TEST(FreeRotation, OnlyTheMiddleAxisIsUnstable) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 w = Vec3::Constant(0.02);
    w[axis] = 20;
    const Vec3 L = kBox.cwiseProduct(w);
    const FreeRotation rotation(kBox);
    Quat q = Quat::Identity();
    double lowest = 1;
    for (int n = 0; n < 3000; ++n) {
      rotateFreely(rotation, L, kRotationStep, q);
      lowest = std::min(lowest, (q.conjugate() * L)[axis] / L.norm());
    }
    if (axis == 1)
      EXPECT_LT(lowest, -0.99);
    else
      EXPECT_GT(lowest, 0.99);
  }
}

TEST(FreeRotation, KeepsEnergyForAMinute) {
  const Vec3 L = kBox.cwiseProduct(Vec3(10, 7, 15));
  const FreeRotation rotation(kBox);
  Quat q = Quat::Identity();
  const double before = energy(rotation, q, L);
  double worst = 0;
  for (int n = 0; n < 60000; ++n) {
    rotateFreely(rotation, L, kRotationStep, q);
    worst = std::max(worst, std::abs(energy(rotation, q, L) / before - 1));
  }
  EXPECT_LE(worst, 1e-11);  // a fourth-order ripple, no drift: the same after 1 s and after 60 s
}

TEST(FreeRotation, StaysAUnitQuaternionForAMillionSteps) {
  const FreeRotation rotation(kBox);
  Quat q = Quat::Identity();
  for (int n = 0; n < 1000000; ++n) rotateFreely(rotation, kBox.cwiseProduct(Vec3(10, 7, 15)), kRotationStep, q);
  EXPECT_NEAR(q.norm(), 1, 5e-16);
}

TEST(FreeRotation, ReturnsWhenTimeRunsBack) {
  const Vec3 L = kBox.cwiseProduct(Vec3(10, 7, 15));
  const FreeRotation rotation(kBox);
  Quat q = Quat::Identity();
  for (int n = 0; n < 1000; ++n) rotateFreely(rotation, L, kRotationStep, q);
  for (int n = 0; n < 1000; ++n) rotateFreely(rotation, L, -kRotationStep, q);
  EXPECT_LE(angleBetween(q, Quat::Identity()), 1e-12);
}

// Which axis is called which doesn't matter: permuted moments give the permuted motion.
RC_GTEST_PROP(FreeRotation, KnowsNoPreferredAxis, ()) {
  const auto number = [](int low, int high) { return 1e-3 * *rc::gen::inRange(1000 * low, 1000 * high); };
  const double a = number(2, 4), b = number(4, 5), c = number(5, 6);
  const Vec3 w(number(-50, 50), number(-50, 50), number(-50, 50));
  Mat3 turn;  // x -> y -> z -> x
  turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Vec3 moments(a, b, c);
  const Quat q = advance(moments, moments.cwiseProduct(w), kRotationStep, 100);
  const Quat turned = advance(turn * moments, turn * moments.cwiseProduct(w), kRotationStep, 100);
  RC_ASSERT(angleBetween(Quat(turn) * q * Quat(turn).conjugate(), turned) <= 1e-12);
}

TEST(FreeRotation, AngularVelocityIsThatOfTheMotion) {
  const Vec3 L = kBox.cwiseProduct(Vec3(10, 7, 15));
  const FreeRotation rotation(kBox);
  Quat before = advance(kBox, L, kRotationStep, 100), after = before;
  const Vec3 w = angularVelocity(rotation, before, L);
  const double h = 1e-4;
  rotateFreely(rotation, L, -h, before);
  rotateFreely(rotation, L, h, after);
  const Vec3 difference = (after * before.conjugate()).vec() / h;
  EXPECT_LE((difference - w).norm(), 1e-3 * w.norm());  // h^2 |w|^2 of the central difference
}

}  // namespace
}  // namespace pincer::engine
