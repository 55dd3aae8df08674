// emulated_hand: a simulated participant whose fingers wear the emulated devices: it feels only
// what they render, and pulls at their arms.
#pragma once
#include <memory>
#include <vector>

#include "pincer/tasks/lab/experiments/pickup_scene.h"
#include "pincer/tasks/lab/participants/scripted_pickup.h"
#include "pincer/tests/emulation/firmware.h"

namespace pincer::emulation {

class EmulatedHand {
 public:
  EmulatedHand(std::vector<std::shared_ptr<ArmFirmware>> arms, std::vector<std::shared_ptr<DisplayFirmware>> displays);
  // A millisecond of its life; the devices have been advanced by as much.
  void act();

 private:
  std::vector<std::shared_ptr<ArmFirmware>> arms_;
  std::vector<std::shared_ptr<DisplayFirmware>> displays_;
  tasks::TrialCues cues_;
  tasks::ScriptedPickup participant_{1};
  double time_ = 0, begin_again_ = -1;  // [s]
};

}  // namespace pincer::emulation
