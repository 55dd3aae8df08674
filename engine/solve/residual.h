// residual: how far impulses are from obeying the contact law, in a way that nothing that isn't finite can pass.
//
//   error     max_i w_i |r_i - P_K(r_i - u~_i / w_i)|   [m/s]
//   u~_i = u_i + mu_i |u_iT| e_n,   w_i  mean of W_ii's diagonal
//   residual  error / max(|q|_inf, kVelocityFloor, 1e-4 max_i w_i r_in)   [-]
//
// The last term of the maximum speaks up only where W r cancels to less than 1e-4 of itself (mass ratios
// above 1e4), and keeps a tolerance of 1e-10 above the round-off of that sum. Both are infinite if
// anything isn't finite (a NaN never passes).
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/engine/solve/cone.h"
#include "pincer/engine/solve/solver_scratch.h"

namespace pincer::engine {

// The slowest motion that counts as motion; residuals are relative to the speeds
// of the problem, but never to less [m/s].
constexpr double kVelocityFloor = 1e-6;

struct ContactError {
  double residual = std::numeric_limits<double>::infinity();  // [-]
  double speed = std::numeric_limits<double>::infinity();     // the error [m/s]
};

// The largest natural map of all contacts.
class WorstResidual {
 public:
  // error2    squared natural map [(m/s)^2]
  // u_n       normal velocity: where it is infinite the natural map may still be finite [m/s]
  // response  w r_n, the part of u_n that comes from the contact itself [m/s]
  void add(double error2, double u_n, double response) {
    worst2_ = std::max(worst2_, error2);
    response_ = std::max(response_, response);
    check_ += error2 + u_n;  // a maximum forgets a NaN, a sum doesn't
  }
  ContactError relativeTo(double speed) const {
    if (!std::isfinite(check_)) return {};
    const double worst = std::sqrt(worst2_);
    return {worst / std::max(speed, kCancellation * response_), worst};
  }

 private:
  static constexpr double kCancellation = 1e-4;  // of the largest response: what W r may cancel to
  double worst2_ = 0;
  double response_ = 0;
  double check_ = 0;
};

// Puts `r` into the cones; a contact whose impulse isn't finite gets none.
void projectOntoCones(const ContactProblem& problem, double* r);

// w of a contact: the mean of W_ii's diagonal [1/kg].
double weightOf(std::span<const ContactSide> sides, int rows);
// Fills scratch.weight.
void weighContacts(const ContactProblem& problem, SolverScratch& scratch);

// scratch.y = A^T r
void respond(const ContactProblem& problem, const double* r, SolverScratch& scratch);

// u = A y + q and the error of r, where the contacts are weighed and scratch.y is A^T r.
ContactError respondedError(const ContactProblem& problem, const double* r, const SolverScratch& scratch, double* u);

// Both.
inline ContactError errorOf(const ContactProblem& problem, const double* r, SolverScratch& scratch, double* u) {
  respond(problem, r, scratch);
  return respondedError(problem, r, scratch, u);
}

// max(|q|_inf, kVelocityFloor) [m/s].
double referenceSpeed(const ContactProblem& problem);

// Of the tolerance: what a strict problem asks of its warm start.
constexpr double kStrictness = 1e-4;
// Of Newton's method from within the tolerance to round-off: it converges quadratically there.
constexpr int kPolishSteps = 2;

// The residual at which a warm start counts as exact: what round-off asks for has no impulses that last.
//   speed  of the problem, referenceSpeed;  noise  its [m/s]
inline double exactResidual(double tolerance, double noise, double speed) {
  return std::max(kStrictness * tolerance, std::min(tolerance, noise / speed));
}

// True if the warm start, of the error `start`, is the answer: within the tolerance, exact where the problem is strict;
// or what doesn't move stays so.
//   speed  of the problem, referenceSpeed
bool isGoodStart(const ContactProblem& problem, const SolverOptions& options, const ContactError& start, double speed);

// The fastest slip of what pushes [m/s].
double fastestSlip(const ContactProblem& problem, const double* r, const double* u);

}  // namespace pincer::engine
