// recorded_hands: the hands of a person's trial as they were recorded, to do it again: each tick is
// given to the bit what it was given then.
#pragma once
#include <vector>

#include "pincer/tasks/lab/experiments/hand_trial.h"
#include "pincer/tasks/lab/experiments/hands.h"

namespace pincer::tasks {

class RecordedHands final : public Hands {
 public:
  // Has the trial, which must outlive it, keep to what it kept to then. `inputs`: of ticks 0, 1, 2, ...; at least one.
  RecordedHands(HandTrial& trial, const HandsRecord& hands, std::vector<InputRecord> inputs);

  void advanceTo(double now) override;
  double time(double now) const override;
  const std::vector<FingerInputs>& sample() override { return samples_; }
  void apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) override;
  const HandIntent& intent() const override { return intent_; }
  bool more() const override { return next_ < inputs_.size(); }

 private:
  HandTrial& trial_;
  const std::vector<InputRecord> inputs_;
  std::size_t next_ = 0;
  std::vector<FingerInputs> samples_;
  HandIntent intent_;
};

}  // namespace pincer::tasks
