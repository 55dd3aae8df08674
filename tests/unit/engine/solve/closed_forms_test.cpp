// The contact solver against answers that can be written down.
#include <gtest/gtest.h>

#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/tests/support/constants.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::ContactScene;
using tests::kGravity;
using tests::OwnedContactProblem;
using tests::solve;
using tests::Solved;

constexpr double kTolerance = 1e-10;  // of the solver, relative to the problem's velocities
constexpr double kStep = 1e-3;        // [s]
constexpr double kFall = kGravity * kStep;

// A ball on a plane: W = diag(1/m + R^2/I, 1/m + R^2/I, 1/m).
class Ball : public testing::TestWithParam<Vec3> {
 public:
  static constexpr double m = 0.1, R = 0.02, I = 0.4 * m * R * R, mu = 0.3;
  OwnedContactProblem problem(const Vec3& v, double friction = mu) const {
    ContactScene scene;
    scene.addBody({0, 0, R}, m, I, v, Vec3::Zero());
    scene.addContact(0, -1, Vec3::Zero(), Vec3::UnitZ(), friction);
    return scene.build();
  }
};

TEST_P(Ball, ObeysCoulombsLawInClosedForm) {
  const Vec3 v = GetParam();
  OwnedContactProblem p = problem(v);
  const Solved s = solve(p);
  ASSERT_TRUE(s.result.converged);
  const double mobility = 1 / m + R * R / I;
  const double normal = std::max(0.0, -v.z() * m);
  const Vec2 q_T = p.q.head<2>();
  const bool sticks = q_T.norm() / mobility <= mu * normal;
  const Vec2 expected = normal == 0 ? Vec2(0, 0)
                        : sticks    ? Vec2(-q_T / mobility)
                                    : Vec2(-mu * normal * q_T.normalized());
  EXPECT_NEAR(s.r[2], normal, kTolerance * m);
  EXPECT_LE((s.r.head<2>() - expected).norm(), kTolerance * m);
  EXPECT_LE((s.u.head<2>() - (q_T + mobility * expected)).norm(), 4 * kTolerance);
  EXPECT_NEAR(s.u[2], std::max(0.0, v.z()), kTolerance);  // no dilation: sliding stays tangential
}
INSTANTIATE_TEST_SUITE_P(Modes, Ball,
                         testing::Values(Vec3(0, 0, -kFall), Vec3(1e-3, 2e-3, -kFall), Vec3(0.3, -0.1, -kFall),
                                         Vec3(-2, 1, -kFall), Vec3(0.3, 0.2, 0.1), Vec3(0.3, 0, 0)));

TEST_F(Ball, SlidesFreelyWithoutFriction) {
  OwnedContactProblem p = problem({0.3, -0.1, -kFall}, 0);
  const Solved s = solve(p);
  ASSERT_TRUE(s.result.converged);
  EXPECT_EQ(s.r[0], 0);
  EXPECT_EQ(s.r[1], 0);
  EXPECT_NEAR(s.r[2], m * kFall, kTolerance * m);
}

// Friction is isotropic: turning the push turns the answer. A pyramid would fail by several per cent.
TEST_F(Ball, SlidesTheSameInEveryDirection) {
  for (int degree = 0; degree < 360; degree += 7) {
    const Vec3 push(std::cos(degree * M_PI / 180), std::sin(degree * M_PI / 180), 0);
    OwnedContactProblem p = problem(push + Vec3(0, 0, -kFall));
    const Solved s = solve(p);
    ASSERT_TRUE(s.result.converged);
    const Vec2 q_T = p.q.head<2>();
    EXPECT_LE((s.r.head<2>() + mu * m * kFall * q_T.normalized()).norm(), kTolerance * m);
  }
}

// A box on its four corners: twelve rows of rank six. The sums over the corners are unique, the shares aren't.
struct BoxOnCorners {
  static constexpr double m = 0.2, half = 0.02;
  OwnedContactProblem problem;
  Eigen::Matrix<double, 3, 1> sum;
  Solved solved;

  BoxOnCorners(const Vec3& v, double mu) {
    ContactScene scene;
    scene.addBody({0, 0, half}, m, m * 4 * half * half / 6, v, Vec3::Zero());
    for (const double x : {-half, half})
      for (const double y : {-half, half}) scene.addContact(0, -1, {x, y, 0}, Vec3::UnitZ(), mu);
    problem = scene.build();
    solved = solve(problem);
    sum = solved.r.segment<3>(0) + solved.r.segment<3>(3) + solved.r.segment<3>(6) + solved.r.segment<3>(9);
  }
};

TEST(BoxOnFourCorners, RestsWithoutMoving) {
  const BoxOnCorners box({0, 0, -kFall}, 0.5);
  ASSERT_TRUE(box.solved.result.converged);
  EXPECT_LE(box.solved.u.norm(), kTolerance);
  EXPECT_NEAR(box.sum.z(), box.m * kFall, kTolerance * box.m);
  for (int i = 0; i < 4; ++i)
    // round-off over epsilon (newton.h) is 1e-5
    EXPECT_NEAR(box.solved.r[3 * i + 2], box.m * kFall / 4, 1e-4 * box.m * kFall);
}

TEST(BoxOnFourCorners, SlidesAgainstTheWholeFriction) {
  const double mu = 0.4;
  const BoxOnCorners box({0.3, 0.4, -kFall}, mu);
  ASSERT_TRUE(box.solved.result.converged);
  EXPECT_NEAR(box.sum.z(), box.m * kFall, kTolerance * box.m);
  EXPECT_NEAR(box.sum.head<2>().norm(), mu * box.m * kFall, kTolerance * box.m);
  const Mat3 R = frameFromNormal(Vec3::UnitZ());
  const Vec3 direction = R * Vec3(box.sum.x(), box.sum.y(), 0);
  EXPECT_NEAR(direction.x() / direction.y(), 0.75, 1e-9);
}

// Two fingers squeeze with N each (compliant normals, R r_n = bias): stick iff m g /
// 2 <= mu N, else u_T = g h - 2 mu N h / m.
class Pinch : public testing::TestWithParam<double> {
 public:
  static constexpr double m = 0.1, N = 2, limit = m * kGravity / (2 * N), compliance = 1.0;
  OwnedContactProblem problem(double mu) const {
    ContactScene scene;
    scene.addBody(Vec3::Zero(), m, 1.6e-5, {0, 0, -kFall}, Vec3::Zero());
    for (const double side : {-1.0, 1.0})
      scene.addContact(0, -1, {0.02 * side, 0, 0}, {-side, 0, 0}, mu, 0, -compliance * N * kStep);
    OwnedContactProblem p = scene.build();
    for (const int contact : {0, 1}) p.soften(contact, compliance);
    return p;
  }
};

TEST_P(Pinch, HoldsExactlyUpToTheLimit) {
  const double mu = GetParam() * limit;
  OwnedContactProblem p = problem(mu);
  const Solved s = solve(p);
  ASSERT_TRUE(s.result.converged);
  const double slip = std::max(0.0, kFall - 2 * mu * N * kStep / m);
  for (const int first : {0, 3}) {
    EXPECT_NEAR(s.r[first + 2], N * kStep, kTolerance * N);
    EXPECT_NEAR(s.u.segment<2>(first).norm(), slip, kTolerance);
    EXPECT_NEAR(s.r.segment<2>(first).norm(), std::min(mu * N, m * kGravity / 2) * kStep, kTolerance * N);
  }
}
INSTANTIATE_TEST_SUITE_P(AroundTheLimit, Pinch, testing::Values(1.02, 1 + 1e-6, 1 - 1e-6, 0.98, 0.5));

// A plate between two soft fingers, its centre of mass d beside their axis: holds iff (m
// g / 2)^2 + (m g d / (2 e))^2 <= (mu N)^2.
class HeldPlate : public testing::TestWithParam<double> {};

TEST_P(HeldPlate, TurnsAndSlidesBeyondTheLimitSurfaceOnly) {
  const double m = 0.1, N = 3, d = 0.004, e = 0.003, compliance = 1.0;
  const double mu = GetParam() * std::hypot(m * kGravity / 2, m * kGravity * d / (2 * e)) / N;
  ContactScene scene;
  scene.addBody({0, d, 0}, m, 2e-5, {0, 0, -kFall}, Vec3::Zero());
  for (const double side : {-1.0, 1.0})
    scene.addContact(0, -1, {0.005 * side, 0, 0}, {-side, 0, 0}, mu, e, -compliance * N * kStep);
  OwnedContactProblem p = scene.build();
  for (const int contact : {0, 1}) p.soften(contact, compliance);
  const Solved s = solve(p);
  ASSERT_TRUE(s.result.converged);
  for (const int first : {0, 4}) {
    const double friction = std::sqrt(tangentNorm2(s.r.data() + first, 4)),
                 slip = std::sqrt(tangentNorm2(s.u.data() + first, 4));
    EXPECT_NEAR(s.r[first + 2], N * kStep, kTolerance * N);
    if (GetParam() >= 1) {
      EXPECT_LE(slip, kTolerance);
    } else {
      EXPECT_NEAR(friction, mu * N * kStep, kTolerance * N);
      EXPECT_GT(slip, 1e-4 * (1 - GetParam()));
      // slip is normal to the limit surface: against friction, in all three rows together
      EXPECT_NEAR(tangentDot(s.r.data() + first, s.u.data() + first, 4), -friction * slip, 1e-9 * friction * slip);
    }
  }
  if (GetParam() < 1) return;
  // How the two fingers share the torque is open; what they bear together isn't (their
  // normals, the torques' axes, are opposite).
  EXPECT_NEAR(std::abs(s.r[3] - s.r[7]), m * kGravity * d / e * kStep, kTolerance * m);
}
INSTANTIATE_TEST_SUITE_P(AroundTheLimit, HeldPlate, testing::Values(1.02, 1.0001, 0.9999, 0.98, 0.5));

TEST(Solver, HasNothingToDoWithoutContacts) {
  OwnedContactProblem p = ContactScene().build();
  const Solved s = solve(p);
  EXPECT_EQ(s.result.method, SolveMethod::kNoContact);
  EXPECT_TRUE(s.result.converged);
}

// Numbers that aren't finite never pass for a solution, and never come out.
TEST(Solver, ReportsWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinite, -infinite}) {
    for (int place = 0; place < 12; ++place) {
      OwnedContactProblem p = BoxOnCorners({0, 0, -kFall}, 0.5).problem;
      (place < 6 ? p.sides[static_cast<std::size_t>(place) % 4][0].A[place / 2][place] : p.q[place]) = bad;
      const Solved s = solve(p);
      EXPECT_FALSE(s.result.converged) << place << " " << bad;
      EXPECT_EQ(s.result.method, SolveMethod::kNotConverged);
      EXPECT_TRUE(s.r.allFinite());
    }
  }
}

TEST(Solver, NeverAcceptsANonFiniteResidual) {
  OwnedContactProblem p = BoxOnCorners({0, 0, -kFall}, 0.5).problem;
  const ContactProblem view = p.view();
  Eigen::VectorXd u(12);
  SolverScratch scratch(4, 1);
  for (int row = 0; row < 12; ++row) {
    Eigen::VectorXd r = Eigen::VectorXd::Constant(12, 1e-3);
    for (const double bad :
         {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
      r[row] = bad;
      EXPECT_FALSE(contactResidual(view, r, scratch, u) <= 1e300) << row;
    }
  }
}

TEST(Solver, StartsAfreshFromANonFiniteWarmStart) {
  OwnedContactProblem p = BoxOnCorners({0.01, 0, -kFall}, 0.5).problem;
  const Eigen::VectorXd warm = Eigen::VectorXd::Constant(12, std::nan(""));
  EXPECT_TRUE(solve(p, {}, &warm).result.converged);
}

// Out of iterations: flagged, in the cones, and no energy comes from nowhere.
TEST(Solver, AddsNoEnergyWhereItGivesUp) {
  tests::RandomScenes random(5);
  int unfinished = 0;
  for (int n = 0; n < 200; ++n) {
    OwnedContactProblem p = random.stack(3, 100, 0.05);
    const Eigen::VectorXd warm = Eigen::VectorXd::Constant(p.q.size(), random.uniform(0, 0.1));
    Solved s{warm, warm, {}};
    SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
    scratch.operations_left = 1000;
    s.result = solveContacts(p.view(), {}, scratch, {s.r.data(), s.r.size()}, {s.u.data(), s.u.size()});
    if (s.result.converged) continue;
    ++unfinished;
    EXPECT_LE(s.r.dot(p.q + 0.5 * (p.W * s.r)), 1e-15);
    EXPECT_EQ(s.result.method, SolveMethod::kNotConverged);
  }
  EXPECT_GT(unfinished, 100);
}

}  // namespace
}  // namespace pincer::engine
