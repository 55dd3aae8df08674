// solver: the contact solver as a user sees it: the rows of a contact, what may be asked of a solve, and how it went.
//
// A contact has rows along t1, t2, n (frame C) [m/s, N s], with torsion one about n, with rolling two more
// about t1 and t2 (scaled to m/s and N s by the radii of Material). The equations:
// engine/solve/contact_problem.h and docs/engine.md.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace pincer::engine {

constexpr int kNormalRow = 2;                             // rows 0 and 1 are t1 and t2
constexpr int kPointRows = 3;                             // of a contact without torsion and rolling: t1, t2, n
constexpr int kMaxContactRows = 6;                        // t1, t2, n, torsion, two of rolling
constexpr int kTorsionRow = kPointRows, kRollingRow = 4;  // about n; the first of two, about t1 and t2

// of one contact; rows that it doesn't have are 0
using ContactVector = Eigen::Matrix<double, kMaxContactRows, 1, Eigen::DontAlign>;

// Methods that are tried for up to sixty contacts where Newton's method fails.
enum class SolverEffort : std::uint8_t {
  kShort,   // a short search
  kInside,  // then an interior point
  kAll,     // then a long search
};

struct SolverOptions {
  double tolerance = 1e-10;  // on the residual, see solve/residual.h [-]; range [1e-14, 1e-2]
  // The dial between time and error: by how much the contact velocities of more than sixty contacts may
  // be off while they move [m/s], 0 .. 1; 0: to the tolerance. Fewer contacts, and what is about to
  // rest, are always solved to the tolerance.
  double accuracy = 1e-6;
  // By how much contacts that contradict each other may give way, see SolveResult [m/s].
  double largest_give = 0;
  SolverEffort effort = SolverEffort::kAll;
  // Most that the iterations of all solves of a tick may cost [s], 0 or 1e-6 .. 10; 0: no limit. Counted in
  // multiplications, not measured, so that results don't depend on what else the machine does. Where it runs out the
  // best iterate counts, flagged and energy-safe.
  double budget = 0;
};

enum class SolveMethod : std::uint8_t {
  kNoContact,
  kWarmStart,
  kNewton,
  kAlternation,
  kInteriorPoint,
  kSweeps,
  kNotConverged
};

struct SolveResult {
  SolveMethod method = SolveMethod::kNoContact;
  int iterations = 0;   // of all methods together
  double residual = 0;  // of the returned impulses [-]
  double error = 0;     // the same as a velocity [m/s]
  double start = 0;     // residual of the warm start [-]
  // To the tolerance, or to the accuracy. False: the impulses are the best iterate in the
  // cones, scaled so that they add no energy.
  bool converged = true;
  double give = 0;  // not 0: contacts that contradict each other gave way, by so much at most [m/s]
  // no answer exists, walls squeeze: the impulses are those of contacts that are a little soft, not converged
  bool yields = false;
};

}  // namespace pincer::engine
