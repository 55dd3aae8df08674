#include "engine/solve/squeeze.h"

#include <algorithm>

#include "engine/solve/mobility.h"
#include "engine/solve/residual.h"

namespace pincer::engine {

bool isSqueezed(const ContactProblem& problem, const double* r) {
  double least_mobility = std::numeric_limits<double>::infinity(), largest = 0;
  for (int i = 0; i < problem.contactCount(); ++i) {
    largest = std::max(largest, r[problem.firstRow(i) + kNormalRow]);
    for (const ContactSide& side : problem.sides[static_cast<std::size_t>(i)]) {
      const double mobility = side.mover < 0 ? 0 : dot6(side.A[kNormalRow], side.A[kNormalRow]);
      if (mobility > 0) least_mobility = std::min(least_mobility, mobility);
    }
  }
  return largest * least_mobility > kLargestSqueeze * referenceSpeed(problem);
}

}  // namespace pincer::engine
