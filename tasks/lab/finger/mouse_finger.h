// mouse_finger: a finger on a mouse, with a simulated contact location display that
// nobody feels; the keys are the window's.
#pragma once
#include "pincer/devices/window/mouse_hand.h"
#include "pincer/tasks/lab/finger/answer_box.h"
#include "pincer/tasks/lab/finger/simulated_finger.h"

namespace pincer::tasks {

class MouseFinger final : public WornFinger {
 public:
  // `keys` outlives it.
  MouseFinger(const FingerPlace& place, AnswerBox& keys);

  const FingerWear& wear() const override { return wear_; }
  void advanceTo(double now) override;
  const FingerInputs& sample() override;
  FingerDeed apply(const FingerOutputs& outputs, Cue cue, double now) override;
  void setTransmission(const devices::VirtualTransmission& transmission) override {
    display_.setTransmission(transmission);
  }
  double tactorPlace() const override { return tactor_place_; }

  devices::MouseHand& hand() { return hand_; }

 private:
  AnswerBox& keys_;
  devices::MouseHand hand_;
  devices::SimOneDofCld display_;
  FingerWear wear_;
  FingerInputs inputs_;
  double now_ = 0, tactor_place_ = 0;  // [s], [m]
};

}  // namespace pincer::tasks
