// verify: the accuracy suite. Named scenes whose exact answer is known (tasks/judge/exact), run and compared; `pincer
// verify` shows it, the tests run it, and its bounds are what pincer promises.
#pragma once
#include <vector>

#include "pincer/tasks/run/measure/measurement.h"

namespace pincer::tasks {

// All of it, in the order of docs/accuracy.md. Names: "pinch/hold", "slide/incline", ...
std::vector<Measurement> verifyMeasurements();

// Its parts, one source file each.
std::vector<Measurement> verifyPinches();
std::vector<Measurement> verifyPads();
std::vector<Measurement> verifyGripFamilies();
std::vector<Measurement> verifySliding();
std::vector<Measurement> verifyRolling();
std::vector<Measurement> verifyFreeBodies();
std::vector<Measurement> verifyCompounds();
std::vector<Measurement> verifyTrees();
std::vector<Measurement> verifyLoops();
std::vector<Measurement> verifyClearance();
std::vector<Measurement> verifyJointLimits();
std::vector<Measurement> verifyGrippers();
std::vector<Measurement> verifyRobots();
std::vector<Measurement> verifyTreeEquations();
std::vector<Measurement> verifyHands();
std::vector<Measurement> verifyToppling();
std::vector<Measurement> verifyBouncing();
std::vector<Measurement> verifyMasonry();
std::vector<Measurement> verifyInvariance();

}  // namespace pincer::tasks
