// finger_records: what one finger's devices said to a tick, and where it led, as a record, there and
// back; and what a trial knew of the finger.
#pragma once
#include "pincer/tasks/lab/finger/worn_finger.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

// Bits of FingerRecord::flags.
enum FingerFlag : std::int32_t { kTouching = 1, kSliding = 2, kGateTripped = 4, kTactorParked = 8 };

// Allocates nothing.
FingerInputRecord fingerInputRecord(const FingerInputs& inputs, const FingerOutputs& output);
// To the bit what fingerInputRecord() was given.
FingerInputs samplesOf(const FingerInputRecord& record);

HandsRecord::Finger handsRecordOf(const FingerWear& wear);
devices::ArmCapabilities capabilitiesOf(const HandsRecord::Finger& finger);

}  // namespace pincer::tasks
