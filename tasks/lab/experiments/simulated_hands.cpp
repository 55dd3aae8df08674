#include "pincer/tasks/lab/experiments/simulated_hands.h"

#include "pincer/contact/functions/invariants.h"

namespace pincer::tasks {
namespace {

constexpr std::size_t kThumb = 1;     // index of a hand's fingers
constexpr double kThumbRing = 0.021;  // [m]; the index finger's has 19 mm (Doxon 2014, ch. 4)

}  // namespace

SimulatedHands::SimulatedHands(const HandScene& scene, Participant& participant)
    : participant_(participant), samples_(kHandFingers) {
  for (std::size_t i = 0; i < kHandFingers; ++i) {
    devices::SimArmSettings arm;
    arm.serial = scene.model.grasp.fingers[i].name;
    arm.start_D = scene.model.mounts[i].X_WD.inverse() * scene.homes_W[i];
    arms_.emplace_back(arm);
    arms_.back().setGimbal(scene.q_DF[i]);
    devices::SimCldSettings display;
    display.serial = arm.serial;
    if (i == kThumb) display.geometry.ring_radius = kThumbRing;
    displays_.emplace_back(display);
  }
  participant_.begin(scene.cues);
  // The hand is on the arm before the first tick.
  apply(std::vector<FingerOutputs>(kHandFingers), Cue::kNone, 0);
}

void SimulatedHands::advanceTo(double now) {
  const double dt = now - time_;
  if (!(dt > 0)) return;
  time_ = now;
  for (auto& arm : arms_) arm.advance(dt);
  for (auto& display : displays_) display.advance(dt);
}

const std::vector<FingerInputs>& SimulatedHands::sample() {
  for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i] = {arms_[i].sample(), displays_[i].sample()};
  return samples_;
}

void SimulatedHands::apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) {
  PINCER_ASSERT(outputs.size() == samples_.size());
  Percept percept;
  percept.time = now;
  percept.cue = cue;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    arms_[i].commandForce(outputs[i].f_D);
    displays_[i].command(outputs[i].tactile);
    percept.fingers[i] = {samples_[i].arm, outputs[i].f_D, samples_[i].tactile};
  }
  action_ = participant_.act(percept);
  for (std::size_t i = 0; i < arms_.size(); ++i) arms_[i].setHand(action_.pulls[i]);
}

}  // namespace pincer::tasks
