// Accelerated sweeps.
#include "pincer/engine/solve/sweeps.h"

#include <gtest/gtest.h>

#include "pincer/engine/solve/contact_solver.h"
#include "pincer/engine/solve/local_contact.h"
#include "pincer/engine/solve/residual.h"
#include "pincer/engine/solve/search.h"
#include "pincer/tests/support/contact_problems.h"

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
    const ContactProblem problem = p.view();
    const double enough = kEnough * referenceSpeed(problem);
    SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
    weighContacts(problem, scratch);
    ContactError error = errorOf(problem, r.data(), scratch, u.data());
    for (int tick = 0; tick < 200 && error.speed > enough; ++tick)
      error = Sweeps(problem, scratch, r.data()).until(enough, error, u.data()).error;
    residual = error.residual;
  }
};

// Where the velocities are unique, as in Solver.NewtonAndGaussSeidelAgree.
TEST(Sweeps, SweepsFindWhatNewtonFinds) {
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

// The impulses of a hit were the start of the tick after it, which then asked for ten times as much as it would have
// without any.
TEST(Sweeps, SearchBeginsWithNoneWhereTheStartIsWorse) {
  RandomScenes random(23);
  for (int n = 0; n < 20; ++n) {
    OwnedContactProblem p = random.cluster(20, 80, 10, 0.5, false);
    const ContactProblem problem = p.view();
    Eigen::VectorXd r[2] = {Eigen::VectorXd::Zero(p.q.size()), Eigen::VectorXd::Zero(p.q.size())}, u(p.q.size());
    for (int i = 0; i < problem.contactCount(); ++i) r[1][problem.firstRow(i) + kNormalRow] = 10;
    for (Eigen::VectorXd& start : r) {
      SolverScratch scratch(problem.contactCount(), p.movers);
      searchImpulses(problem, {}, scratch, start.data(), u.data());
    }
    EXPECT_EQ(r[0], r[1]) << n;
  }
}

// How many sweeps it takes to a residual of 1e-6.
int sweepsFor(OwnedContactProblem& p, bool accelerated) {
  constexpr int kMost = 4000;
  const ContactProblem problem = p.view();
  SolverScratch scratch(static_cast<int>(p.mu.size()), p.movers);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(p.q.size()), u = r;
  contactResidual(problem, r, scratch, u);
  Sweeps method(problem, scratch, r.data());
  for (int sweeps = 1; sweeps < kMost; ++sweeps) {
    method.sweep(false);
    if (respondedError(problem, r.data(), scratch, u.data()).residual <= 1e-6) return sweeps;
    if (accelerated) method.accelerate();
  }
  return kMost;
}

// Energy without the shift of what slides carries it on and on: of 56 problems of a heap that falls 24 weren't solved
// in 2000 sweeps, and 28 sweeps are enough on average.
TEST(Sweeps, AccelerationIsNotMisledByWhatSlides) {
  RandomScenes random(25);
  int plain = 0, accelerated = 0;
  for (int n = 0; n < 60; ++n) {
    OwnedContactProblem p = random.stack(12, 1, 0.3);  // boxes that are pushed about: some slide, some stick
    plain += sweepsFor(p, false);
    accelerated += sweepsFor(p, true);
  }
  EXPECT_LE(2 * accelerated, plain);  // by 3 on average; ten of the problems by 1.3 to 5.7
}

// Where two spheres touch W is a multiple of the identity along the surface: the closed form is what
// the search for the root finds beside it.
TEST(Sweeps, SpheresClosedFormIsTheLimitOfTheRootSearch) {
  RandomScenes random(23);
  for (int n = 0; n < 1000; ++n) {
    const double w_T = random.uniform(1, 100), w_n = random.uniform(1, 100), mu = random.uniform(0.01, 2),
                 off = 1e-9 * w_T;
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
