// Contacts too many for Newton's method: accelerated sweeps.
#include <gtest/gtest.h>

#include "engine/solve/large_problem.h"
#include "engine/solve/local_contact.h"
#include "tests/support/contact_problems.h"

namespace pincer::engine {
namespace {

using tests::OwnedContactProblem;
using tests::RandomScenes;

// From tick to tick, each from what the last one reached, until the residual is 1e-10.
struct Ticks {
  Eigen::VectorXd r, u;
  double residual = 0;

  explicit Ticks(OwnedContactProblem& p) : r(Eigen::VectorXd::Zero(p.q.size())), u(r) {
    constexpr double kEnough = 1e-10;
    SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
    residual = contactResidual(p.view(), r, scratch, u);
    for (int tick = 0; tick < 200 && residual > kEnough; ++tick)
      residual = solveLargeProblem(p.view(), kEnough, residual, scratch, r.data(), u.data()).residual;
  }
};

// Where the velocities are unique, as in Solver.NewtonAndGaussSeidelAgree.
TEST(LargeProblem, SweepsFindWhatNewtonFinds) {
  RandomScenes random(21);
  int compared = 0;
  for (int n = 0; n < 100; ++n) {
    OwnedContactProblem p = random.grasp(2, 1, n % 2 == 1);
    const Ticks swept(p);
    const tests::Solved newton = tests::solve(p);
    if (!newton.result.converged || swept.residual > 1e-10) continue;
    ++compared;
    EXPECT_LE((newton.u - swept.u).norm(), 1e-7 * p.q.norm());  // both to 1e-10, times the condition of W
  }
  EXPECT_GE(compared, 95);
}

// Where two spheres touch W is a multiple of the identity along the surface: the closed form is what the search for the root finds beside it.
TEST(LargeProblem, SpheresClosedFormIsTheLimitOfTheRootSearch) {
  RandomScenes random(23);
  for (int n = 0; n < 1000; ++n) {
    const double w_T = random.uniform(1, 100), w_n = random.uniform(1, 100), mu = random.uniform(0.01, 2), off = 1e-9 * w_T;
    const double isotropic[9] = {w_T, 0, 0, 0, w_T, 0, 0, 0, w_n};
    const double nearly[9] = {w_T, off, 0, off, w_T, off, 0, off, w_n};
    const Vec3 q = random.vector(1);
    Vec3 r, s;
    solveOneContact(isotropic, 3, q.data(), 3, mu, r.data());
    solveOneContact(nearly, 3, q.data(), 3, mu, s.data());
    EXPECT_LE((r - s).norm(), 1e-7 * r.norm()) << n;  // 1e-9 of W, times its condition
  }
}

}  // namespace
}  // namespace pincer::engine
