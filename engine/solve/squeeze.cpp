#include "pincer/engine/solve/squeeze.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/residual.h"

namespace pincer::engine {

namespace {

// No contact that moves something does so by more than W_nn r_n, at most the trace of W_ii: heaps needn't look at their sides.
bool maySqueeze(const ContactProblem& problem, const std::vector<double>& weight, const double* r, double most) {
  double largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i)
    largest = std::max(largest, problem.rows(i) * weight[static_cast<std::size_t>(i)] * r[problem.firstRow(i) + kNormalRow]);
  return largest > most;
}

}  // namespace

bool isSqueezed(const ContactProblem& problem, const std::vector<double>& weight, const double* r) {
  const double most = kLargestSqueeze * referenceSpeed(problem);
  if (!maySqueeze(problem, weight, r, most)) return false;
  double least_mobility = std::numeric_limits<double>::infinity(), largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    largest = std::max(largest, r[problem.firstRow(i) + kNormalRow]);
    for (const ContactSide& side : problem.sidesOf(i)) {
      const double mobility = side.mover < 0 ? 0 : dot6(side.A[kNormalRow], side.A[kNormalRow]);
      if (mobility > 0) least_mobility = std::min(least_mobility, mobility);
    }
  }
  return largest * least_mobility > most;
}

}  // namespace pincer::engine
