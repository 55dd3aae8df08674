// Contacts that slide far slower than what presses them: friction's direction hangs on digits of the slip.
#include <gtest/gtest.h>

#include <cmath>

#include "pincer/engine/solve/cone.h"
#include "pincer/tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::ContactScene;
using tests::OwnedContactProblem;
using tests::RandomScenes;

// A part that lies in a dish on three places, between two fingertips that touch it with two places each.
OwnedContactProblem partInDish(RandomScenes& random) {
  ContactScene scene;
  scene.addBody(Vec3::Zero(), 0.05, 1e-5, Vec3::Zero(), Vec3::Zero());
  for (int i = 0; i < 3; ++i) {
    const double about = 2 * M_PI * (i + random.uniform(-0.3, 0.3)) / 3;
    const Vec3 p(0.012 * std::cos(about), 0.012 * std::sin(about), -0.015);
    scene.addContact(0, -1, p, Vec3(-p.x(), -p.y(), 0.15).normalized(), 0.4, 0.002);
  }
  for (const double side : {-1.0, 1.0}) {
    constexpr double kNeverTurns = 1e3;  // inertia of a tip [kg m^2]
    const int tip = scene.addBody(Vec3(0.025 * side, 0, 0), 0.01, kNeverTurns, Vec3::Zero(), Vec3::Zero());
    for (const double y : {-0.008, 0.008})
      scene.addContact(tip, 0, Vec3(0.018 * side, y, random.uniform(-5e-3, 5e-3)),
                       (Vec3(side, 0, 0) + 0.3 * random.vector(1)).normalized(), 0.45, 0.002);
  }
  return scene.build();
}

// Impulses and velocities that obey the law, with slips of `slip` [m/s]; they say what q is.
Eigen::VectorXd knownAnswer(RandomScenes& random, double slip, OwnedContactProblem& p) {
  Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
  for (std::size_t i = 0; i < p.mu.size(); ++i) {
    const int first = p.first_row[i], rows = p.first_row[i + 1] - first, mode = random.integer(0, 3);
    if (mode == 0) {
      u[first + kNormalRow] = random.uniform(0, 0.1);
      continue;
    }
    Eigen::VectorXd t(rows);
    for (int k = 0; k < rows; ++k) t[k] = k == kNormalRow ? 0 : random.uniform(-1, 1);
    t.normalize();
    const double pressed = random.uniform(3e-4, 3e-3), used = mode == 1 ? random.uniform(0, 0.95) : 1;
    r.segment(first, rows) = used * p.mu[i] * pressed * t;
    r[first + kNormalRow] = pressed;
    if (mode > 1) u.segment(first, rows) = -slip * random.uniform(0.1, 1) * t;
  }
  p.q = u - p.W * r;
  return r;
}

// `pincer run sphere-pickup --object bunny.obj`: the interior point ended with errors of 1e-8 of the speeds, as much as
// parts in the dish slip, and contacts seemed to contradict each other. They gave way after a millisecond of sweeps, in
// 3 of 100 ticks.
TEST(SlowSlip, OfAPartInADishIsFoundInAShortSearch) {
  RandomScenes random(31);
  SolverOptions options;
  options.effort = SolverEffort::kInside;
  int failed = 0;
  for (int n = 0; n < 1000; ++n) {
    OwnedContactProblem p = partInDish(random);
    Eigen::VectorXd start = knownAnswer(random, std::pow(10, random.uniform(-7, -4)), p);
    for (double& r : start) r *= random.uniform(0.5, 1.5);
    failed += !tests::solve(p, options, &start).result.converged;
  }
  EXPECT_LE(failed, 20);
}

}  // namespace
}  // namespace pincer::engine
