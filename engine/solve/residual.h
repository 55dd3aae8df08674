// residual: how far impulses are from obeying the contact law, in a way that nothing that isn't finite can pass.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "pincer/engine/solve/cascade.h"
#include "pincer/engine/solve/cone.h"

namespace pincer::engine {

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
  double relativeTo(double speed) const {
    return std::isfinite(check_) ? std::sqrt(worst2_) / std::max(speed, kCancellation * response_)
                                 : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double kCancellation = 1e-4;
  double worst2_ = 0;
  double response_ = 0;
  double check_ = 0;
};

// Fills scratch.weight: w_i, the means of W_ii's diagonals [1/kg].
void weighContacts(const ContactProblem& problem, SolverScratch& scratch);

// contactResidual where the weights are known.
double weighedResidual(const ContactProblem& problem, const double* r, SolverScratch& scratch, double* u);

// The same where scratch.y is A^T r already.
double respondedResidual(const ContactProblem& problem, const double* r, SolverScratch& scratch, double* u);

// max(|q|_inf, kVelocityFloor) [m/s].
double referenceSpeed(const ContactProblem& problem);

// The residual at which a warm start counts as exact, for a problem of speeds of order `speed` [m/s]: what the round-off of gaps asks for, 5e-17 m of
// which a tick of 1 ms undoes a fifth, has no impulses that last.
inline double exactResidual(double tolerance, double speed) {
  constexpr double kGapNoise = 1e-14;  // [m/s]
  return std::max(kStrictness * tolerance, std::min(tolerance, kGapNoise / speed));
}

}  // namespace pincer::engine
