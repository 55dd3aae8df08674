#include "pincer/engine/solve/squeeze.h"

#include <algorithm>
#include <limits>

#include "pincer/engine/solve/mobility.h"
#include "pincer/engine/solve/residual.h"

namespace pincer::engine {

namespace {

// No contact that moves something does so by more than W_nn r_n, at most the trace of
// W_ii: heaps needn't look at their sides.
bool maySqueeze(const ContactProblem& problem, const std::vector<double>& weight, const double* r, double most) {
  double largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i)
    largest =
        std::max(largest, problem.rows(i) * weight[static_cast<std::size_t>(i)] * r[problem.firstRow(i) + kNormalRow]);
  return largest > most;
}

// In the direction in which it moves most: pushed along its axis a joint hardly moves, and isn't heavy for that.
double mobilityOf(const ContactSide& side) {
  if (side.mover < 0) return 0;
  double most = 0;
  for (int k = 0; k < kTorsionRow; ++k) most = std::max(most, dot6(side.A[k], side.A[k]));
  return most;
}

}  // namespace

bool isSqueezed(const ContactProblem& problem, const std::vector<double>& weight, const double* r) {
  constexpr double kRoundOff = 1e-12;  // of the contact's own mobility: what moves by less than that isn't moved by it
  const double most = kLargestSqueeze * referenceSpeed(problem);
  if (!maySqueeze(problem, weight, r, most)) return false;
  double least_mobility = std::numeric_limits<double>::infinity(), largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    largest = std::max(largest, r[problem.firstRow(i) + kNormalRow]);
    for (const ContactSide& side : problem.sidesOf(i)) {
      const double mobility = mobilityOf(side);
      if (mobility > kRoundOff * weight[static_cast<std::size_t>(i)])
        least_mobility = std::min(least_mobility, mobility);
    }
  }
  return largest * least_mobility > most;
}

}  // namespace pincer::engine
