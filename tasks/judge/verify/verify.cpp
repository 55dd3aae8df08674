#include "pincer/tasks/judge/verify/verify.h"

#include <iterator>

namespace pincer::tasks {

std::vector<Measurement> verifyMeasurements() {
  std::vector<Measurement> all;
  for (const auto part :
       {verifyPinches, verifyPads, verifyGripFamilies, verifySliding, verifyRolling, verifyFreeBodies, verifyCompounds,
        verifyTrees, verifyLoops, verifyClearance, verifyJointLimits, verifyGrippers, verifyRobots, verifyTreeEquations,
        verifyHands, verifyToppling, verifyBouncing, verifyMasonry, verifyInvariance}) {
    std::vector<Measurement> some = part();
    std::move(some.begin(), some.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace pincer::tasks
