// Contacts that stick, more than the movers can tell apart, against the least norm of a dense pseudo-inverse.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/stuck_contacts.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Row by row what the sides stand for, all movers side by side.
MatrixXd factorOf(const tests::OwnedContactProblem& p) {
  MatrixXd A = MatrixXd::Zero(p.q.size(), kMoverFreedoms * p.movers);
  for (std::size_t i = 0; i < p.sides.size(); ++i) {
    for (const ContactSide& side : p.sides[i]) {
      for (int k = p.first_row[i]; side.mover >= 0 && k < p.first_row[i + 1]; ++k) {
        for (int j = 0; j < kMoverFreedoms; ++j) A(k, kMoverFreedoms * side.mover + j) = side.A[k - p.first_row[i]][j];
      }
    }
  }
  return A;
}

// A body of 0.1 kg between `fingers` pads around it, of four corners each: points that don't turn if
// `are_points`, else bodies of `pad_mass`. Motions of the movers, at random, are what the contacts have to stop;
// consistent, as those of corners of one pad are.
tests::OwnedContactProblem heldByPads(int fingers, double pad_mass, bool are_points, tests::RandomScenes& random) {
  tests::ContactScene scene;
  const auto motion = [&] { return Vec3(0.01 * random.vector(1)); };
  const int body = scene.addBody(Vec3::Zero(), 0.1, 4e-5, motion(), motion());
  for (int f = 0; f < fingers; ++f) {
    const double angle = 2 * M_PI * f / fingers;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), across(-out.y(), out.x(), 0);
    const int pad = scene.addBody(0.03 * out, pad_mass, 4e-5, motion(), are_points ? Vec3(Vec3::Zero()) : motion());
    for (const double y : {-0.01, 0.01}) {
      for (const double z : {-0.01, 0.01})
        scene.addContact(pad, body, 0.02 * out + y * across + Vec3(0, 0, z), out, 0.8);
    }
  }
  tests::OwnedContactProblem p = scene.build();
  for (ContactSides& sides : p.sides) {
    for (ContactSide& side : sides) {
      side.is_point = are_points && side.mover != body;
      for (int k = 0; side.is_point && k < kTorsionRow; ++k) std::fill(side.A[k] + 3, side.A[k] + kMoverFreedoms, 0.0);
    }
  }
  p.W = factorOf(p) * factorOf(p).transpose();
  return p;
}

struct StuckTrial {
  VectorXd r, u;
  SolveResult result;
  bool solved;
};

StuckTrial solveStuck(tests::OwnedContactProblem& p, const VectorXd& start) {
  const ContactProblem problem = p.view();
  SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
  StuckTrial trial{start, start, {}, false};
  weighContacts(problem, scratch);
  const ContactError error = errorOf(problem, trial.r.data(), scratch, trial.u.data());
  trial.result.residual = trial.result.start = error.residual;
  trial.solved = solveStuckContacts(problem, {}, scratch, trial.r.data(), trial.u.data(), trial.result);
  return trial;
}

// Squeezed evenly, far inside of the cones.
VectorXd squeeze(const tests::OwnedContactProblem& p, double impulse) {
  VectorXd r = VectorXd::Zero(p.q.size());
  for (const int first : std::span(p.first_row).first(p.mu.size())) r[first + kNormalRow] = impulse;
  return r;
}

TEST(StuckContacts, TakeTheNearestImpulsesThatHold) {
  tests::RandomScenes random(5);
  for (const int fingers : {2, 3, 5, 8}) {
    for (const double pad_mass : {1e-3, 0.1, 3.0}) {
      for (const bool are_points : {true, false}) {
        if (!are_points && fingers > 3) continue;  // more bodies than are taken
        SCOPED_TRACE(testing::Message() << fingers << " fingers of " << pad_mass << " kg, points " << are_points);
        tests::OwnedContactProblem p = heldByPads(fingers, pad_mass, are_points, random);
        const VectorXd start = squeeze(p, 10);
        p.q -= p.W * start;
        const VectorXd missing = -(p.W * start + p.q);
        const StuckTrial trial = solveStuck(p, start);
        ASSERT_TRUE(trial.solved);
        EXPECT_LE(trial.result.iterations, 2);
        EXPECT_LT((p.W * trial.r + p.q).cwiseAbs().maxCoeff(), 1e-9 * (p.W * start).cwiseAbs().maxCoeff());
        const VectorXd nearest = p.W.completeOrthogonalDecomposition().pseudoInverse() * missing;
        // W's condition is at most 1e5 here, and the pseudo-inverse's round-off that times 1e-16 times the squeeze.
        EXPECT_LT((trial.r - start - nearest).norm(), 1e-8 * start.norm());
      }
    }
  }
}

// Of pads that are points. Half of the corners press three times as hard as all would, the others hardly: the step of
// least change takes 5.5 from each, so that the others would open, and declines. Then the least norm of all counts.
TEST(StuckContacts, ShareAnewFromNone) {
  tests::RandomScenes random(8);
  for (const int fingers : {2, 3, 5}) {
    tests::OwnedContactProblem p = heldByPads(fingers, 0.05, true, random);
    p.q -= p.W * squeeze(p, 10);
    VectorXd lopsided = squeeze(p, 30);
    for (std::size_t i = 0; i < p.mu.size(); i += 2) lopsided[p.first_row[i] + kNormalRow] = 1;
    const StuckTrial trial = solveStuck(p, lopsided);
    ASSERT_TRUE(trial.solved) << fingers;
    const VectorXd least = -p.W.completeOrthogonalDecomposition().solve(p.q);
    EXPECT_LT((trial.r - least).norm(), 1e-8 * least.norm()) << fingers;
  }
}

TEST(StuckContacts, OpenCornersStayOpen) {
  tests::RandomScenes random(6);
  tests::OwnedContactProblem p = heldByPads(2, 0.1, true, random);
  VectorXd start = squeeze(p, 10);
  for (const int corner : {1, 6}) start[3 * corner + kNormalRow] = 0;
  p.q -= p.W * start;
  // flies off faster than any impulse here brings it back
  for (const int corner : {1, 6}) p.q[3 * corner + kNormalRow] += 1e3;
  const StuckTrial trial = solveStuck(p, start);
  ASSERT_TRUE(trial.solved);
  EXPECT_EQ(trial.r.segment<3>(3), Vec3(Vec3::Zero()));
  EXPECT_EQ(trial.r.segment<3>(18), Vec3(Vec3::Zero()));
  EXPECT_LE(trial.result.residual, 1e-10);
}

TEST(StuckContacts, LeaveWhatSlidesAsItWas) {
  tests::RandomScenes random(7);
  tests::OwnedContactProblem p = heldByPads(2, 0.1, true, random);
  p.q.array() += 10;  // more than friction holds
  const VectorXd start = squeeze(p, 1e-3);
  const StuckTrial trial = solveStuck(p, start);
  EXPECT_FALSE(trial.solved);
  EXPECT_EQ(trial.r, start);
  EXPECT_LT((trial.u - p.W * start - p.q).norm(), 1e-14 * p.q.norm()) << "velocities of the warm start";
}

}  // namespace
}  // namespace pincer::engine
