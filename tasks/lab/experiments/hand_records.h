// hand_records: a tick of a manipulation task as a SampleRecord, and what it was
// given as an InputRecord, there and back.
#pragma once
#include <vector>

#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/finger/finger_records.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// Object and fingers; trial, tick, time, tick_us and status are left to the caller. Allocates nothing.
SampleRecord sampleRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                          const std::vector<FingerInputs>& samples);

// The devices' samples, the hand's intents, and where they led; trial, tick, time, cut and status
// are left to the caller. Allocates nothing.
InputRecord inputRecord(const HandScene& scene, const TickState& state, const TickScratch& scratch,
                        const std::vector<FingerInputs>& samples, const HandIntent& intent);
// To the bit what inputRecord() was given.
HandIntent intentOf(const InputRecord& record);

}  // namespace pincer::tasks
