// A point between walls whose biases contradict each other.
#include "pincer/engine/solve/point_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::OwnedContactProblem;
using tests::RandomScenes;

// A tip of 1 g pressed at up to 3 m/s between `walls` walls, each sloping by up to pi/2 - `steepest` out of a groove or
// pit that leads off at random. What they ask for contradicts itself by `contradiction` [m/s].
OwnedContactProblem pit(RandomScenes& random, int walls, double steepest, double contradiction) {
  const double root = 1 / std::sqrt(1e-3), half_opening = random.uniform(steepest, 1.3);
  const Mat3 groove = frameFromNormal(random.direction());  // third axis: out of it, first: along it
  const Vec3 v_free = groove * Vec3(random.uniform(-1, 1), random.uniform(-0.3, 0.3), -random.uniform(0.5, 3));
  OwnedContactProblem p;
  p.movers = 1;
  p.sides.resize(static_cast<std::size_t>(walls));
  p.q.resize(3 * walls);
  Eigen::MatrixXd A(3 * walls, 3);
  for (int i = 0; i < walls; ++i) {
    const double about = M_PI / 2 + 2 * M_PI * i / walls + (walls > 2 ? random.uniform(-0.7, 0.7) : 0);
    const double slope = walls > 2 ? random.uniform(steepest, 1.3) : half_opening;
    const Mat3 R = frameFromNormal(
        groove * Vec3(std::cos(slope) * std::cos(about), std::cos(slope) * std::sin(about), std::sin(slope)));
    A.block<3, 3>(3 * i, 0) = root * R.transpose();
    p.q.segment<3>(3 * i) = R.transpose() * v_free + random.vector(contradiction);
    p.mu.push_back(random.uniform(0.3, 0.7));
    p.first_row.push_back(3 * (i + 1));
    ContactSide& side = p.sides[static_cast<std::size_t>(i)][0];
    side = {.mover = 0, .is_point = true, .A = {}};
    for (int k = 0; k < 3; ++k) Eigen::Map<Vec3>(side.A[k]) = A.row(3 * i + k);
  }
  p.W = A * A.transpose();
  return p;
}

// How far within the cones K*, as a share of its length, the motion is that is furthest within them all. Only if it is
// above 0 an answer is sure to exist, whatever the biases (Acary, Cadoux, Lemarechal & Malick 2011, section 3).
double roomToLeave(const OwnedContactProblem& p) {
  constexpr int kDirections = 20000;  // on Fibonacci's spiral, 0.014 rad apart
  double most = -1;
  for (int n = 0; n < kDirections; ++n) {
    const double z = 1 - (2 * n + 1.0) / kDirections, turn = n * M_PI * (3 - std::sqrt(5.0)),
                 radius = std::sqrt(1 - z * z);
    const Vec3 y(radius * std::cos(turn), radius * std::sin(turn), z);
    double least = 1;
    for (std::size_t i = 0; i < p.mu.size(); ++i) {
      using Rows = Eigen::Matrix<double, 3, kMoverFreedoms, Eigen::RowMajor>;
      const Mat3 A = Eigen::Map<const Rows>(p.sides[i][0].A[0]).leftCols<3>();
      const Vec3 u = A * y;
      least = std::min(least, (u[2] - p.mu[i] * u.head<2>().norm()) / A.row(2).norm());
    }
    most = std::max(most, least);
  }
  return most;
}

// True if the sets of walls that may push are enough, whatever other methods find.
bool isEnumerated(OwnedContactProblem& p) {
  SolverScratch scratch(static_cast<int>(p.mu.size()), 1);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
  double residual = std::numeric_limits<double>::infinity();
  weighContacts(p.view(), scratch);
  return solvePointProblem(p.view(), 1e-10, scratch, r.data(), u.data(), residual);
}

// `pincer bench contact --only 'scene/drag*' --meshes DIR`: up to 98 of 20,000 ticks of a finger in grooves of real
// meshes were flagged, at residuals of 1e-6.
class PointProblem : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Walls, PointProblem, testing::Values(2, 3, 4));

TEST_P(PointProblem, IsSolvedWhereTheWallsContradictEachOther) {
  RandomScenes random(21);
  for (int n = 0; n < 3000; ++n) {
    // no two walls lock: tan(0.7) > 0.7
    OwnedContactProblem p = pit(random, GetParam(), 0.7, std::pow(10, random.uniform(-7, -4)));
    const tests::Solved s = solve(p);
    ASSERT_TRUE(s.result.converged) << n << ' ' << s.result.residual;
    ASSERT_TRUE(isEnumerated(p)) << n;
    for (int i = 0; i < GetParam(); ++i)
      ASSERT_TRUE(isInCone(s.r.data() + 3 * i, 3, p.mu[static_cast<std::size_t>(i)], 1e-12)) << n;
  }
}

TEST_P(PointProblem, FailsOnlyInGroovesThatLock) {
  RandomScenes random(23);
  int failed = 0;
  for (int n = 0; n < 3000; ++n) {
    OwnedContactProblem p = pit(random, GetParam(), 0.44, std::pow(10, random.uniform(-7, -4)));
    if (solve(p).result.converged) continue;
    ++failed;
    EXPECT_LT(roomToLeave(p), 0) << n;
  }
  EXPECT_LE(failed, 30);  // of two walls 19
}

// Walls that agree leave the point on one line: sliding along it, with the friction of both, is known in closed form.
TEST(PointProblem, SlidesAlongAGrooveAsInClosedForm) {
  RandomScenes random(22);
  int slides = 0;
  for (int n = 0; n < 1000; ++n) {
    OwnedContactProblem p = pit(random, 2, 0.44, 0);
    p.mu[0] = p.mu[1] = 0.1;  // so that many slide
    SolverScratch scratch(2, 1);
    Eigen::VectorXd r = Eigen::VectorXd::Zero(6), u(6);
    double residual = 0;
    ASSERT_TRUE(isPointProblem(p.view()));
    weighContacts(p.view(), scratch);
    if (!solvePointProblem(p.view(), 1e-10, scratch, r.data(), u.data(), residual) || r[2] == 0 || r[5] == 0) continue;
    const double slip = u.head<2>().norm();
    if (slip < 1e-6) continue;
    ++slides;
    EXPECT_NEAR(u[2], 0, 1e-12);
    EXPECT_NEAR(u[5], 0, 1e-12);
    EXPECT_NEAR(u.segment<2>(3).norm(), slip, 1e-12);  // one point, one groove
    const double r_n = r[2] + r[5];
    EXPECT_NEAR(r.head<2>().norm() + r.segment<2>(3).norm(), p.mu[0] * r_n, 1e-12 * r_n);
    EXPECT_NEAR(r.head<2>().dot(u.head<2>()), -p.mu[0] * r[2] * slip, 1e-12 * r_n);
  }
  EXPECT_GT(slides, 100);
}

}  // namespace
}  // namespace pincer::engine
