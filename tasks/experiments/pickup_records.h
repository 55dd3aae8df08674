// pickup_records: a tick of the pickup task as a SampleRecord.
#pragma once
#include <vector>

#include "tasks/experiments/pickup_scene.h"
#include "tasks/session/records.h"

namespace pincer::tasks {

// Object and fingers; trial, tick, time, tick_us and status are left to the caller. Allocates nothing.
SampleRecord sampleRecord(const PickupScene& scene, const TickState& state, const TickScratch& scratch,
                          const std::vector<FingerInputs>& samples);

}  // namespace pincer::tasks
