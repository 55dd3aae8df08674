#include "pincer/tasks/lab/experiments/recorded_hands.h"

#include <cmath>

#include "pincer/contact/functions/invariants.h"
#include "pincer/tasks/lab/experiments/hand_records.h"

namespace pincer::tasks {
namespace {

Vec3 vectorOf(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

RecordedHands::RecordedHands(HandTrial& trial, const HandsRecord& hands, std::vector<InputRecord> inputs)
    : trial_(trial), inputs_(std::move(inputs)), samples_(kHandFingers) {
  PINCER_ASSERT(!inputs_.empty());
  std::array<ArmBase, kHandFingers> bases;
  for (std::size_t i = 0; i < bases.size(); ++i) {
    bases[i] = {vectorOf(hands.fingers[i].base_offset_W), hands.fingers[i].base_turn};
    trial.fitTo(static_cast<int>(i), capabilitiesOf(hands.fingers[i]));
  }
  if (!std::isnan(bases[0].turn)) trial.standArms(bases);
  if (!std::isnan(hands.oldest_sample)) trial.trustSamples(hands.oldest_sample);
  if (hands.passive != 0) trial.keepPassive();
}

void RecordedHands::advanceTo(double) {
  PINCER_ASSERT(next_ < inputs_.size());
  const InputRecord& input = inputs_[next_];
  if (input.cut != 0) trial_.cutForces(static_cast<devices::Trip>(input.cut));
  for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i] = samplesOf(input.fingers[i]);
  intent_ = intentOf(input);
}

double RecordedHands::time(double) const { return inputs_[next_].time; }

void RecordedHands::apply(const std::vector<FingerOutputs>&, Cue, double) { ++next_; }

}  // namespace pincer::tasks
