// hand_records: a tick of a manipulation task as a SampleRecord.
#pragma once
#include <vector>

#include "tasks/experiments/hand_scene.h"
#include "tasks/session/records.h"

namespace pincer::tasks {

// Object and fingers; trial, tick, time, tick_us and status are left to the caller. Allocates nothing.
SampleRecord sampleRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                          const std::vector<FingerInputs>& samples);

}  // namespace pincer::tasks
