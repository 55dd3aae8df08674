// mouse_hands: two fingers on a mouse, with simulated contact location displays, in a trial. At
// the end of a trial they open and go home.
#pragma once
#include <vector>

#include "pincer/devices/cld/sim_cld.h"
#include "pincer/devices/window/mouse_hand.h"
#include "pincer/tasks/lab/experiments/hand_scene.h"
#include "pincer/tasks/lab/experiments/hands.h"
#include "pincer/tasks/lab/finger/answer_box.h"

namespace pincer::tasks {

class MouseHands final : public Hands {
 public:
  // `keys`: Enter answers; null: nobody answers. It outlives the hands.
  explicit MouseHands(const HandScene& scene, AnswerBox* keys = nullptr);

  void advanceTo(double now) override;
  const std::vector<FingerInputs>& sample() override;
  void apply(const std::vector<FingerOutputs>& outputs, Cue cue, double now) override;
  // Who squeezes wants to lift.
  const HandIntent& intent() const override { return intent_; }

  devices::MouseHand& hand() { return hand_; }

 private:
  devices::MouseHand hand_;
  std::vector<devices::SimCld> displays_;
  std::vector<FingerInputs> samples_;
  HandIntent intent_;
  AnswerBox* keys_;
  double time_ = 0;
};

}  // namespace pincer::tasks
