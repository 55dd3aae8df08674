// The step of a grip, against the same step by blocks of A and dense algebra.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "pincer/engine/solve/grip_problem.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/stuck_contacts.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using Eigen::VectorXd;

struct GripScene {
  tests::OwnedContactProblem p;
  GripProblem grip;
  std::vector<Mat3> frames;
  std::vector<Vec3> arms;
  Eigen::MatrixXd A;

  // A's rows of a contact, as grip_problem.h has them.
  void fill(std::size_t i) {
    const GripContact& c = grip.contact[i];
    ContactSides& sides = p.sides[i];
    sides[0].mover = 0;
    sides[1].mover = c.point < 0 ? -1 : 1 + c.point;
    sides[1].is_point = true;
    for (int k = 0; k < kTorsionRow; ++k) {
      const Vec3 axis = c.R_WC->col(k), turn = grip.F.transpose() * c.arm_W->cross(axis);
      for (int j = 0; j < 3; ++j) {
        sides[0].A[k][j] = c.sign * grip.root_inverse_mass * axis[j];
        sides[0].A[k][3 + j] = c.sign * turn[j];
        sides[1].A[k][j] = c.point < 0 ? 0 : -c.sign * grip.point_root[static_cast<std::size_t>(c.point)][j] * axis[j];
        sides[1].A[k][3 + j] = 0;
        for (int b = 0; b < 2; ++b) {
          const int first = kMoverFreedoms * std::max(sides[static_cast<std::size_t>(b)].mover, 0),
                    row = 3 * static_cast<int>(i) + k;
          A(row, first + j) += sides[static_cast<std::size_t>(b)].A[k][j];
          A(row, first + 3 + j) += sides[static_cast<std::size_t>(b)].A[k][3 + j];
        }
      }
    }
  }
  void setVelocities(const VectorXd& start, tests::RandomScenes& random) {
    VectorXd motion(A.cols());
    for (Eigen::Index j = 0; j < motion.size(); ++j) motion[j] = random.uniform(-0.01, 0.01);
    p.q = A * motion - p.W * start;  // what corners of rigid pads do together
  }
};

// `points` faces of `corners` each around a body of 0.1 kg, and as many contacts with the floor; each contact in a
// frame of its own, or as its face.
GripScene makeGrip(int points, int corners, int on_floor, bool own_frames, tests::RandomScenes& random) {
  GripScene s;
  s.grip.root_inverse_mass = std::sqrt(1 / 0.1);
  s.grip.F = Quat(1, 0.3, -0.2, 0.5).normalized().toRotationMatrix() * Vec3(150, 120, 200).asDiagonal();
  s.grip.points = points;
  for (int f = 0; f <= points; ++f) {
    const bool is_floor = f == points;
    if (!is_floor) s.grip.point_root[static_cast<std::size_t>(f)] = Vec3(1, 2, 3) + 0.1 * random.vector(1);
    const double angle = 2 * M_PI * f / std::max(points, 1);
    const Vec3 out = is_floor ? Vec3(0, 0, -1) : Vec3(std::cos(angle), std::sin(angle), 0);
    for (int k = 0; k < (is_floor ? on_floor : corners); ++k) {
      const Vec3 across = is_floor ? Vec3(0, 1, 0) : Vec3(-out.y(), out.x(), 0), up = out.cross(across);
      const double turn = own_frames ? random.uniform(0, 6) : 0.3;
      Mat3 R = frameFromNormal(is_floor ? Vec3(-out) : out);
      R = R * Quat(std::cos(turn), 0, 0, std::sin(turn)).toRotationMatrix();
      s.frames.push_back(R);
      s.arms.push_back(0.02 * out + (k & 1 ? 0.01 : -0.01) * across + (k & 2 ? 0.008 : -0.008) * up);
      s.p.mu.push_back(0.8);
      s.p.first_row.push_back(s.p.first_row.back() + kTorsionRow);
    }
  }
  const std::size_t n = s.frames.size();
  s.grip.contacts = static_cast<int>(n);
  s.p.sides.resize(n);
  s.p.movers = 1 + points;
  s.A = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(n), kMoverFreedoms * s.p.movers);
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_floor = static_cast<int>(i) >= points * corners;
    s.grip.contact[i] = {&s.frames[i], &s.arms[i], is_floor ? 1.0 : -1.0,
                         is_floor ? -1 : static_cast<int>(i) / corners};
    s.fill(i);
  }
  s.p.W = s.A * s.A.transpose();
  s.p.q = VectorXd::Zero(s.A.rows());
  return s;
}

VectorXd pressed(const GripScene& s, double impulse) {
  VectorXd r = VectorXd::Zero(s.p.q.size());
  for (std::size_t i = 0; i < s.p.mu.size(); ++i) r[3 * static_cast<Eigen::Index>(i) + kNormalRow] = impulse;
  return r;
}

struct Answer {
  VectorXd r, u;
  SolveResult result;
  bool solved;
};
Answer solveGrip(GripScene& s, const VectorXd& start) {
  SolverScratch scratch(static_cast<int>(s.p.mu.size()), s.p.movers);
  Answer out{start, start, {}, false};
  out.solved = solveGripProblem(s.grip, s.p.view(), {}, scratch, out.r.data(), out.u.data(), out.result);
  return out;
}
Answer solveByBlocks(GripScene& s, const VectorXd& start) {
  const ContactProblem problem = s.p.view();
  SolverScratch scratch(static_cast<int>(s.p.mu.size()), s.p.movers);
  Answer out{start, start, {}, false};
  weighContacts(problem, scratch);
  const ContactError error = errorOf(problem, out.r.data(), scratch, out.u.data());
  out.result.residual = out.result.start = error.residual;
  out.solved = solveStuckContacts(problem, {}, scratch, out.r.data(), out.u.data(), out.result);
  return out;
}

void expectTheSame(const Answer& grip, const Answer& blocks) {
  ASSERT_TRUE(blocks.solved);
  ASSERT_TRUE(grip.solved);
  EXPECT_LT((grip.r - blocks.r).norm(), 1e-9 * blocks.r.norm());
  EXPECT_LT((grip.u - blocks.u).norm(), 1e-9 * blocks.r.norm());
  EXPECT_EQ(grip.result.iterations, blocks.result.iterations);
  EXPECT_EQ(grip.result.method, blocks.result.method);
  EXPECT_NEAR(grip.result.start, blocks.result.start, 1e-9 * blocks.result.start);
}

TEST(GripProblem, SaysWhatBlocksOfTheSameContactsSay) {
  tests::RandomScenes random(21);
  for (const int points : {1, 2, 3, 4}) {
    for (const int corners : {2, 3, 4}) {
      for (const int on_floor : {0, 2, 4}) {
        for (const bool own_frames : {false, true}) {
          const int n = points * corners + on_floor;
          if (n < kFewestGripContacts || n > kMostGripContacts) continue;
          SCOPED_TRACE(testing::Message()
                       << points << " points of " << corners << ", floor " << on_floor << " own frames " << own_frames);
          GripScene s = makeGrip(points, corners, on_floor, own_frames, random);
          const VectorXd start = pressed(s, 10);
          s.setVelocities(start, random);
          expectTheSame(solveGrip(s, start), solveByBlocks(s, start));
        }
      }
    }
  }
}

TEST(GripProblem, OpenCornersStayOpen) {
  tests::RandomScenes random(22);
  GripScene s = makeGrip(2, 4, 0, false, random);
  VectorXd start = pressed(s, 10);
  for (const int corner : {1, 6}) start[3 * corner + kNormalRow] = 0;
  s.setVelocities(start, random);
  for (const int corner : {1, 6}) s.p.q[3 * corner + kNormalRow] += 1e3;
  const Answer answer = solveGrip(s, start);
  expectTheSame(answer, solveByBlocks(s, start));
  EXPECT_EQ(answer.r.segment<3>(3), Vec3(Vec3::Zero()));
  EXPECT_EQ(answer.r.segment<3>(18), Vec3(Vec3::Zero()));
}

TEST(GripProblem, LeavesAnExactWarmStartToTheBit) {
  tests::RandomScenes random(23);
  GripScene s = makeGrip(2, 3, 0, false, random);
  const VectorXd start = pressed(s, 10);
  s.p.q = -(s.p.W * start);
  const Answer answer = solveGrip(s, start);
  ASSERT_TRUE(answer.solved);
  EXPECT_EQ(answer.result.method, SolveMethod::kWarmStart);
  EXPECT_EQ(answer.r, start);
}

TEST(GripProblem, DeclinesWhatSlides) {
  tests::RandomScenes random(24);
  GripScene s = makeGrip(2, 4, 0, false, random);
  s.p.q.array() += 10;
  const VectorXd start = pressed(s, 1e-3);
  const Answer answer = solveGrip(s, start);
  EXPECT_FALSE(answer.solved);
  EXPECT_EQ(answer.r, start);
}

}  // namespace
}  // namespace pincer::engine
