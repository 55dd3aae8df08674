#include "pincer/tasks/lab/finger/recorded_finger.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/finger/finger_records.h"

namespace pincer::tasks {

RecordedFinger::RecordedFinger(const HandsRecord& hands, std::vector<InputRecord> inputs) : inputs_(std::move(inputs)) {
  PINCER_ASSERT(!inputs_.empty());
  const HandsRecord::Finger& finger = hands.fingers[0];
  wear_.arm = capabilitiesOf(finger);
  const auto& offset = finger.base_offset_W;
  wear_.base = {{offset[0], offset[1], offset[2]}, std::isnan(finger.base_turn) ? 0 : finger.base_turn};
  if (!std::isnan(hands.oldest_sample)) wear_.oldest_sample = hands.oldest_sample;
  wear_.has_motors = hands.passive != 0;
  wear_.is_person = true;
}

void RecordedFinger::advanceTo(double) {
  PINCER_ASSERT(next_ < inputs_.size());
  samples_ = samplesOf(inputs_[next_].fingers[0]);
}

FingerDeed RecordedFinger::apply(const FingerOutputs& outputs, Cue, double) {
  tactor_place_ = samples_.tactile.place_L.value_or(outputs.tactile.place_L).x();
  return {{}, static_cast<int>(inputs_[next_++].flags >> InputRecord::kKeyShift)};
}

}  // namespace pincer::tasks
