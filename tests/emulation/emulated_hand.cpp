#include "pincer/tests/emulation/emulated_hand.h"

#include "pincer/tasks/lab/experiments/pickup_object.h"

namespace pincer::emulation {

EmulatedHand::EmulatedHand(std::vector<std::shared_ptr<ArmFirmware>> arms,
                           std::vector<std::shared_ptr<DisplayFirmware>> displays)
    : arms_(std::move(arms)), displays_(std::move(displays)) {
  const tasks::SpherePickupOptions options;
  const tasks::HandScene scene =
      tasks::makePickupScene(options, tasks::makePickupObject(options), tasks::PickupTrialSpec{});
  cues_ = scene.cues;
  for (std::size_t i = 0; i < arms_.size(); ++i) arms_[i]->plant().setGimbal(scene.q_DF[i]);
  participant_.begin(cues_);
}

void EmulatedHand::act() {
  time_ += 1e-3;
  tasks::Percept percept;
  percept.time = time_;
  for (std::size_t i = 0; i < arms_.size(); ++i) {
    percept.fingers[i] = {arms_[i]->plant().sample(), arms_[i]->force(), displays_[i]->plant().sample()};
    const usb::Signal signal = arms_[i]->takeSignal();
    if (signal != usb::Signal::kNone) percept.cue = static_cast<tasks::Cue>(signal);
  }
  if (percept.cue == tasks::Cue::kSuccess || percept.cue == tasks::Cue::kEnd) begin_again_ = time_ + 1.5;
  if (begin_again_ > 0 && time_ >= begin_again_) {  // the hand is home, the next trial may come
    participant_.begin(cues_);
    begin_again_ = -1;
  }
  const tasks::HandAction action = participant_.act(percept);
  for (std::size_t i = 0; i < arms_.size(); ++i) arms_[i]->plant().setHand(action.pulls[i]);
}

}  // namespace pincer::emulation
