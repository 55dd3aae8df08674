// simulated_hands: the two arms and displays of the set-up in virtual time, and
// the participant whose fingers wear them.
//
// The participant is given the arms' and displays' samples, the forces that the arms were
// told to render, and tones; nothing else.
#pragma once
#include <array>
#include <vector>

#include "pincer/devices/arm/sim_arm.h"
#include "pincer/devices/cld/sim_cld.h"
#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/experiments/hands.h"
#include "pincer/tasks/lab/participants/participant.h"
#include "pincer/tasks/run/tick/tick.h"

namespace pincer::tasks {

class SimulatedHands final : public Hands {
 public:
  SimulatedHands(const HandScene& scene, Participant& participant);

  // Moves devices to `now` [s]; time never goes back.
  void advanceTo(double now) override;
  const std::vector<FingerInputs>& sample() override;
  // Commands of this tick to the devices, percept to the participant, its pulls to the arms.
  void apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) override;

  const HandIntent& intent() const override { return action_.intent; }

  // For tests that inject faults.
  devices::SimArm& arm(int finger) { return arms_[static_cast<std::size_t>(finger)]; }
  devices::SimCld& display(int finger) { return displays_[static_cast<std::size_t>(finger)]; }

 private:
  Participant& participant_;
  std::vector<devices::SimArm> arms_;
  std::vector<devices::SimCld> displays_;
  std::vector<FingerInputs> samples_;
  HandAction action_;
  double time_ = 0;
};

}  // namespace pincer::tasks
