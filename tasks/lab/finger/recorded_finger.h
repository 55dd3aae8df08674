// recorded_finger: the finger of a person's trial as it was recorded, to do it again: each tick is
// given to the bit what it was given then.
#pragma once
#include <vector>

#include "pincer/tasks/lab/finger/worn_finger.h"
#include "pincer/tasks/run/records.h"

namespace pincer::tasks {

class RecordedFinger final : public WornFinger {
 public:
  // `inputs`: of ticks 0, 1, 2, ...; at least one.
  RecordedFinger(const HandsRecord& hands, std::vector<InputRecord> inputs);

  const FingerWear& wear() const override { return wear_; }
  void advanceTo(double now) override;
  double time(double) const override { return inputs_[next_].time; }
  devices::Trip cut() const override { return static_cast<devices::Trip>(inputs_[next_].cut); }
  const FingerInputs& sample() override { return samples_; }
  FingerDeed apply(const FingerOutputs& outputs, Cue cue, double now) override;
  void setTransmission(const devices::VirtualTransmission&) override {}
  double tactorPlace() const override { return tactor_place_; }
  bool more() const override { return next_ < inputs_.size(); }

 private:
  const std::vector<InputRecord> inputs_;
  std::size_t next_ = 0;
  FingerWear wear_;
  FingerInputs samples_;
  double tactor_place_ = 0;  // [m]
};

}  // namespace pincer::tasks
