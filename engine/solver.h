// solver: the contact solver as a user sees it: the rows of a contact, what may be asked of a solve, and how it went.
//
// A contact has rows along t1, t2, n (frame C) [m/s, N s], with torsion one about n, with rolling two more about t1 and t2 (scaled to m/s and N s by
// the radii of Material). The equations: engine/solve/contact_problem.h and docs/engine.md.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace pincer::engine {

constexpr int kNormalRow = 2;
constexpr int kMaxContactRows = 6;
constexpr int kTorsionRow = 3, kRollingRow = 4;  // about n; the first of two, about t1 and t2

using ContactVector = Eigen::Matrix<double, kMaxContactRows, 1, Eigen::DontAlign>;  // of one contact; rows that it doesn't have are 0

struct SolverOptions {
  double tolerance = 1e-10;  // on the residual, see contactResidual [-]; range [1e-14, 1e-2]
  // What is enough once Newton's method has failed, whichever allows more: a residual [-], or a speed [m/s]. Contacts that contradict each
  // other by the round-off of their gaps (a mesh at rest in a dish) have no better answer, and 10 nm/s is far below anything felt.
  double contentment = 1e-8;
  double content_speed = 1e-8;
  // By how much contacts that contradict each other may give way once Newton's method has failed, see SolveResult [m/s].
  double largest_give = 0;
  int newton_iterations = 12;          // each time that Newton's method is tried
  int proximal_rounds = 12;            // of Newton's method with a proximal term
  int interior_point_iterations = 30;  // each time that the interior-point method is tried
  int shift_updates = 3;               // of the interior-point method with frozen shift
  int gauss_seidel_sweeps = 60;
  int large_sweeps = 10;  // of Gauss-Seidel, where Newton's method failed on many contacts
  // What the iterations of all solves of a tick may cost [s], 0 or 1e-6 .. 10; 0: no limit. Counted in multiplications, not measured, so
  // that results don't depend on what else the machine does. Where it runs out the best iterate counts, flagged and energy-safe.
  double budget = 0;
};

enum class SolveMethod : std::uint8_t { kNoContact, kWarmStart, kNewton, kProximalNewton, kInteriorPoint, kGaussSeidel, kNotConverged };

struct SolveResult {
  SolveMethod method = SolveMethod::kNoContact;
  int iterations = 0;   // of all methods together
  double residual = 0;  // of the returned impulses [-]
  double start = 0;     // residual of the warm start [-]
  // To the tolerance, or to contentment by the costlier methods. False: the impulses are the best iterate in the cones, scaled so that they add no
  // energy.
  bool converged = true;
  double give = 0;      // not 0: contacts that contradict each other gave way, by so much at most [m/s]
  bool yields = false;  // no answer exists, walls squeeze: the impulses are those of contacts that are a little soft, not converged
};

}  // namespace pincer::engine
